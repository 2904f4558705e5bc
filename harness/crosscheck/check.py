"""The cross-check of a record: a verdict on every equation, and on every one that is missing."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from math import factorial
from typing import TypeVar

from ..record import Derivation, Equation, LeftOut, Record, Relation, why_left_out
from . import derivation, initial_motion, lagranges_method
from .claims import NotComparable
from .derivation import DerivationClaims
from .independent import IndependentEquations
from .initial_motion import SceneClaims
from .report import CheckReport, EquationVerdict, Verdict
from .system import MechanicalSystem, described_system
from .verdict import Comparison, judge

STATED = ("1", "2", "3a", "3", "6", "7")
"""Equations that every derivation holds."""

SOLVED = ("4", "5", "8", "8", "9", "10", "11")
"""Equations that a derivation holds, all or none, where their closed form is readable."""

STATED_IN_SCENE = ("12", "19")
SOLVED_IN_SCENE = ("13",)
SERIES_IN_SCENE = ("18",)

Claims = TypeVar("Claims", DerivationClaims, SceneClaims)
Compare = Callable[[Claims, tuple[Relation, ...]], Comparison]

READABLE = 220
"""Up to this size of T, V, Q and f (operations, times g! times n!) closed forms must be there."""

READABLE_SERIES = 100
"""Up to this many operations in (8) and (11) together, (18), which differentiates them, must be there."""


def check_record(record: Record) -> CheckReport:
    """Compare every equation of a record with the independent evaluation.

    Parameters
    ----------
    record : Record

    Returns
    -------
    CheckReport
        Verdicts in the record's order. An equation that should be there and is not disagrees,
        and so does one under a number that has no comparison.
    """
    claims = [_claims(record, derived) for derived in record.derivations]
    verdicts = [found for each in claims for found in _check_derivation(each)]
    verdicts += [found for each in record.derivations for found in _left_out(each.left_out, None)]
    for scene in record.scenes:
        verdicts += _check_scene(SceneClaims(scene, claims[scene.derivation]))
        verdicts += _left_out(scene.left_out, scene.name)
    return CheckReport(tuple(verdicts))


def _claims(record: Record, derived: Derivation) -> DerivationClaims:
    system = described_system(record.system, derived.effects)
    supported = derived.mass_matrix == "supported"
    return DerivationClaims(IndependentEquations(system, supported), tuple(derived.equations))


def _check_derivation(claims: DerivationClaims) -> Iterator[EquationVerdict]:
    for equation in claims.equations:
        yield _verdict(equation, None, claims, derivation.COMPARISONS)
    yield from _missing(_expected(claims), claims.equations, None)
    if lagranges_method.can_take(claims.system):
        third = lagranges_method.compare(claims.known)
        yield _judged(lagranges_method.NUMBER, lagranges_method.NAME, None, third)


def _check_scene(claims: SceneClaims) -> Iterator[EquationVerdict]:
    name = claims.scene.name
    for equation in claims.scene.equations:
        yield _verdict(equation, name, claims, initial_motion.COMPARISONS)
    yield from _missing(_expected_in_scene(claims), claims.scene.equations, name)


def _verdict(
    equation: Equation, scene: str | None, claims: Claims, comparisons: Mapping[str, Compare[Claims]]
) -> EquationVerdict:
    compare = comparisons.get(equation.number)
    if compare is None:
        return _refused(equation.number, equation.name, scene, "no comparison has this number")
    try:
        comparison = compare(claims, equation.relations)
    except NotComparable as reason:
        return _refused(equation.number, equation.name, scene, f"the record holds {reason}")
    return _judged(equation.number, equation.name, scene, comparison)


def _judged(number: str, name: str, scene: str | None, comparison: Comparison) -> EquationVerdict:
    found = judge(comparison, seed=f"{number} {name}")
    return EquationVerdict(number, name, scene, found.verdict, found.digits, found.points, found.detail)


def _refused(number: str, name: str, scene: str | None, reason: str) -> EquationVerdict:
    return EquationVerdict(number, name, scene, Verdict.DISAGREES, None, None, reason)


def _left_out(left_out: LeftOut | None, scene: str | None) -> Iterator[EquationVerdict]:
    if left_out is not None:
        for number in left_out.numbers:
            yield EquationVerdict(number, "(not made)", scene, Verdict.LEFT_OUT, None, None, why_left_out(left_out))


def _missing(expected: Iterable[str], present: Iterable[Equation], scene: str | None) -> Iterator[EquationVerdict]:
    absent = Counter(expected) - Counter(equation.number for equation in present)
    for number in absent.elements():
        yield _refused(number, "(missing)", scene, "the record does not hold this equation")


def _expected(claims: DerivationClaims) -> tuple[str, ...]:
    holds_some = {equation.number for equation in claims.equations} & set(SOLVED)
    return STATED + SOLVED if holds_some or _predicted_size(claims.system) <= READABLE else STATED


def _expected_in_scene(claims: SceneClaims) -> tuple[str, ...]:
    motion = claims.derivation.motion()
    if motion is None:
        return STATED_IN_SCENE
    law = ("10",) if claims.scene.control_law else ()
    holds_series = any(equation.number in SERIES_IN_SCENE for equation in claims.scene.equations)
    operations = sum(int(expression.count_ops()) for expression in motion.values())
    series = SERIES_IN_SCENE if holds_series or operations <= READABLE_SERIES else ()
    return STATED_IN_SCENE + SOLVED_IN_SCENE + series + law


def _predicted_size(system: MechanicalSystem) -> int:
    description = (
        system.kinetic_energy,
        system.potential_energy,
        *system.forces,
        *system.constraints,
    )
    operations = sum(1 + int(expression.count_ops()) for expression in description)
    orders = factorial(len(system.constraints)) * factorial(len(system.coordinates))
    return operations * orders
