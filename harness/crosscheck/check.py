"""The cross-check of a record: a verdict on every equation, and on every one that is missing."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from math import factorial
from typing import NamedTuple, TypeVar

from ..record import Derivation, Equation, LeftOut, Record, Relation
from . import derivation, initial_motion
from .claims import NotComparable
from .derivation import DerivationClaims
from .independent import IndependentEquations
from .initial_motion import SceneClaims
from .points import fresh_seed
from .redundancy import judge_redundancy
from .report import CheckReport, EquationVerdict, Verdict
from .system import MechanicalSystem, described_system
from .verdict import Comparison, judge

STATED = {
    "constraints": "1",
    "lagrange_equations": "2",
    "kinetic_energy": "3a",
    "christoffel_symbols": "6",
    "expanded_equations": "3",
    "constraint_accelerations": "7",
}
"""Equations that every derivation holds: their ids, and the paper's numbers."""

SOLVED = {
    "inverse_mass_matrix": "5",
    "driven_accelerations": "4",
    "multiplier_equations": "8",
    "multipliers": "8",
    "constraint_forces": "9",
    "free_motion_condition": "10",
    "accelerations": "11",
}
"""Equations that a derivation holds, all or none, where their closed form is readable."""

STATED_IN_SCENE = {"initial_state": "12", "determined_initial_values": "19"}
SOLVED_IN_SCENE = {"initial_accelerations": "13"}
SERIES_IN_SCENE = {"initial_series": "18"}
UNDER_LAW_IN_SCENE = {"free_motion_residual": "10"}

Claims = TypeVar("Claims", DerivationClaims, SceneClaims)
Compare = Callable[[Claims, tuple[Relation, ...]], Comparison]

USUAL_LIMIT = 500
"""The library's own `closed_form_size`; the two sizes that follow belong to it, and shrink and grow with another."""

READABLE = 220
"""Up to this size of T, V, Q and f (operations, times g! times n!) closed forms must be there."""

READABLE_SERIES = 100
"""Up to this many operations in (8) and (11) together, (18), which differentiates them, must be there."""


class Place(NamedTuple):
    """Where a verdict belongs: a derivation, by its place in the record, and a scene of it or none."""

    derivation: int
    scene: str | None = None


def check_record(record: Record, seed: str | None = None) -> CheckReport:
    """Compare every equation of a record with the independent evaluation.

    The seed draws the random points; None is for a fresh one.

    Returns
    -------
    CheckReport
        Verdicts in the record's order. An equation that should be there and is not disagrees,
        and so does one whose id has no comparison.
    """
    seed = seed or fresh_seed()
    claims = [_claims(record, derived) for derived in record.derivations]
    verdicts: list[EquationVerdict] = []
    for place, each in enumerate(record.derivations):
        verdicts += _check_derivation(Place(place), claims[place], each.left_out, seed)
        if each.redundant:
            verdicts.append(_check_redundancy(Place(place), claims[place], record, seed))
    for place, each in enumerate(record.derivations):
        verdicts += _left_out(Place(place), each.left_out)
    for scene in record.scenes:
        place = Place(scene.derivation, scene.name)
        verdicts += _check_scene(place, SceneClaims(scene, claims[scene.derivation]), seed)
        verdicts += _left_out(place, scene.left_out)
    return CheckReport(tuple(verdicts), seed)


def _claims(record: Record, derived: Derivation) -> DerivationClaims:
    system = described_system(record.system, derived.effects)
    supported = derived.mass_matrix == "supported"
    return DerivationClaims(
        IndependentEquations(system),
        IndependentEquations(system.without(derived.redundant), supported),
        tuple(derived.equations),
    )


def _check_derivation(
    place: Place, claims: DerivationClaims, left_out: LeftOut | None, seed: str
) -> Iterator[EquationVerdict]:
    for equation in claims.equations:
        yield _verdict(place, equation, claims, derivation.COMPARISONS, seed)
    yield from _missing(place, _expected(claims, left_out), claims.equations)
    from . import lagranges_method  # loads SymPy's mechanics, which nothing else of this package needs

    if lagranges_method.can_take(claims.known.system):
        yield _judged(place, lagranges_method.OPINION, lagranges_method.compare(claims.known), seed)


def _check_redundancy(place: Place, claims: DerivationClaims, record: Record, seed: str) -> EquationVerdict:
    starts = [SceneClaims(scene, claims) for scene in record.scenes if scene.derivation == place.derivation]
    found = judge_redundancy(claims.system, claims.known.system, [each.configuration for each in starts], seed)
    names = ", ".join(each.name for each in claims.system.multipliers if each not in claims.known.system.multipliers)
    what = ("redundant_constraints", "1", f"constraints that follow from the others: those of {names}")
    return EquationVerdict(*what, *place, found.verdict, found.digits, found.points, found.detail)


def _check_scene(place: Place, claims: SceneClaims, seed: str) -> Iterator[EquationVerdict]:
    for equation in claims.scene.equations:
        yield _verdict(place, equation, claims, initial_motion.COMPARISONS, seed)
    yield from _missing(place, _expected_in_scene(claims), claims.scene.equations)


def _verdict(
    place: Place, equation: Equation, claims: Claims, comparisons: Mapping[str, Compare[Claims]], seed: str
) -> EquationVerdict:
    compare = comparisons.get(equation.id)
    if compare is None:
        return _refused(place, equation, "there is no comparison for this equation")
    try:
        comparison = compare(claims, equation.relations)
    except NotComparable as reason:
        return _refused(place, equation, f"the record holds {reason}")
    return _judged(place, equation, comparison, seed)


def _judged(place: Place, equation: Equation, comparison: Comparison, seed: str) -> EquationVerdict:
    found = judge(comparison, seed=f"{seed} {equation.number} {equation.name}")
    what = (equation.id, equation.number, equation.name)
    return EquationVerdict(*what, *place, found.verdict, found.digits, found.points, found.detail)


def _refused(place: Place, equation: Equation, reason: str) -> EquationVerdict:
    what = (equation.id, equation.number, equation.name)
    return EquationVerdict(*what, *place, Verdict.DISAGREES, None, None, reason)


def _left_out(place: Place, left_out: LeftOut | None) -> Iterator[EquationVerdict]:
    if left_out is not None:
        for number in left_out.numbers:
            what = ("", number, "(not made)")
            yield EquationVerdict(*what, *place, Verdict.LEFT_OUT, None, None, "", held=False, left_out=left_out)


def _missing(place: Place, expected: Mapping[str, str], present: Iterable[Equation]) -> Iterator[EquationVerdict]:
    held = {equation.id for equation in present}
    for each, number in expected.items():
        if each not in held:
            absent = Equation(each, number, "(missing)", ())
            yield replace(_refused(place, absent, "the record does not hold this equation"), held=False)


def _expected(claims: DerivationClaims, left_out: LeftOut | None) -> Mapping[str, str]:
    holds_some = any(equation.id in SOLVED for equation in claims.equations)
    return (
        STATED | SOLVED if holds_some or _predicted_size(claims.known.system) <= _share(READABLE, left_out) else STATED
    )


def _expected_in_scene(claims: SceneClaims) -> Mapping[str, str]:
    motion = claims.derivation.motion()
    if motion is None:
        return STATED_IN_SCENE
    law = UNDER_LAW_IN_SCENE if claims.scene.control_law else {}
    holds_series = any(equation.id in SERIES_IN_SCENE for equation in claims.scene.equations)
    operations = sum(int(expression.count_ops()) for expression in motion.values())
    series = SERIES_IN_SCENE if holds_series or operations <= _share(READABLE_SERIES, claims.scene.left_out) else {}
    return STATED_IN_SCENE | SOLVED_IN_SCENE | series | law


def _share(size: int, left_out: LeftOut | None) -> float:
    """What a size comes to under the limit that the record names as the reason for what it leaves out."""
    return size if left_out is None else size * left_out.limit / USUAL_LIMIT


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
