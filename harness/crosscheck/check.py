"""The cross-check of a record: a verdict on every equation and premise.

An equation that is missing has a verdict, too.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

from ..description import Description
from ..language import translatable
from ..record import Derivation, LeftOut, Record, Relation, Scene
from . import derivation, initial_motion
from .derivation import CheckedDerivation
from .independent import IndependentEquations
from .initial_motion import CheckedScene
from .premises import Difference, Premises, differences
from .redundancy import verify_redundancy
from .relations import NotComparable
from .report import OPINION, CheckReport, CheckResult, EquationVerdict, Item, Place, Verdict, verdict_on
from .seed import fresh_seed
from .skeleton import (
    CLOSED_NUMBERS,
    derivation_items,
    has_closed_forms,
    length_of,
    operations_of,
    predicted_size,
    scene_items,
    scene_numbers_left_out,
)
from .system import MechanicalSystem, described_system
from .time_limit import TimeLimit
from .verdict import Comparison, verify_all

Checked = TypeVar("Checked", CheckedDerivation, CheckedScene)
Compare = Callable[[Checked, tuple[Relation, ...]], Comparison | tuple[Comparison, ...]]

OUT_OF_TIME = CheckResult(Verdict.UNDECIDED, None, None, translatable("the time limit was reached before"))


def check_record(
    record: Record,
    description: Description,
    seed: str | None = None,
    seconds: float = math.inf,
) -> CheckReport:
    """Compare every equation of a record with the evaluation of a description.

    Parameters
    ----------
    record : Record
        The record to be checked.
    description : Description
        Description of the scene file. Nothing of it is taken from the record.
    seed : str or None
        Seed of the random points. None is for a fresh one.
    seconds : float
        Time for all verdicts. Equations without a verdict by then are undecided.

    Returns
    -------
    CheckReport
        Verdicts in the record's order. A missing equation disagrees, and so does an unexpected one, and every
        difference between record and description.
    """
    seed = seed or fresh_seed()
    premises = Premises(description)
    return CheckReport(tuple(_Check(record, premises, seed, TimeLimit(seconds)).verdicts()), seed)


class _Check:
    """The check of one record, with its premises."""

    def __init__(self, record: Record, premises: Premises, seed: str, time: TimeLimit) -> None:
        self._record, self._premises, self._seed, self._time = record, premises, seed, time
        self._limit = premises.description.closed_form_size

    def verdicts(self) -> Iterator[EquationVerdict]:
        """Return verdicts on the whole record, in its order."""
        record = self._record
        yield from map(_as_verdict, differences(record, self._premises))
        checked = list(map(self._checked, record.derivations))
        scenes = list(self._scenes(checked))
        for place, (derived, each) in enumerate(zip(record.derivations, checked, strict=True)):
            yield from self._on_derivation(Place(place), derived, each)
            starts = [scene.configuration for scene in scenes if scene.derivation is each]
            yield from self._on_redundancy(Place(place), derived, each, starts)
        for place, derived in enumerate(record.derivations):
            yield from _left_out(Place(place), derived.left_out)
        for each in scenes:
            yield from self._on_scene(Place(each.scene.derivation, each.scene.name), each)

    def _checked(self, derived: Derivation) -> CheckedDerivation:
        system = described_system(self._premises.system, derived.effects)
        independent = system.without(derived.redundant)
        size = predicted_size(self._premises.system, derived, independent, self._limit)
        return CheckedDerivation(
            IndependentEquations(system),
            IndependentEquations(independent, derived.mass_matrix == "supported"),
            tuple(derived.equations),
            size,
            has_closed_forms(derived, size, self._limit),
            len(system.coordinates) ** 2 <= self._limit,
        )

    def _scenes(self, checked: Sequence[CheckedDerivation]) -> Iterator[CheckedScene]:
        stated = {scene.name: scene for scene in self._premises.scenes}
        for scene in self._record.scenes:
            if scene.name in stated and scene.derivation < len(checked):
                yield CheckedScene(scene, stated[scene.name], checked[scene.derivation])

    def _on_derivation(
        self, place: Place, derived: Derivation, checked: CheckedDerivation
    ) -> Iterator[EquationVerdict]:
        closed = checked.closed
        items = derivation_items(closed, derived.mass_matrix == "regular", derived.redundant, checked.all_entries)
        yield from self._on_equations(place, derived, items, checked, derivation.COMPARISONS)
        from . import lagranges_method  # loads SymPy's mechanics, which nothing else of this package needs

        if lagranges_method.can_take(checked.known.system):
            yield self._verify(place, OPINION, lambda: lagranges_method.compare(checked.known), checked.system)
        yield from self._on_left_out(place, derived.left_out, () if closed else CLOSED_NUMBERS, checked.size)
        solved = [each for each in derived.equations if each.id in ("multipliers", "accelerations")]
        operations = operations_of(solved) if closed else None
        if derived.closed_form_operations != operations:
            detail = translatable(
                "the record counts %(recorded)s, and there are %(operations)s",
                recorded=derived.closed_form_operations,
                operations=operations,
            )
            yield _rejected(
                place, Item("closed_form_operations", "", translatable("operations in (8) and (11)")), detail
            )

    def _on_redundancy(
        self, place: Place, derived: Derivation, checked: CheckedDerivation, starts: Sequence[Mapping]
    ) -> Iterator[EquationVerdict]:
        names = [multiplier.name for multiplier in checked.system.multipliers]
        independent_names = [name for name in names if name not in derived.redundant]
        item = Item("redundant_constraints", "1", _redundant_in_words(derived.redundant))
        if [*derived.redundant] != [name for name in names if name not in independent_names]:
            yield _rejected(place, item, translatable("there are no such constraints"))
            return
        regular = derived.mass_matrix == "regular"
        found = self._time.result(
            lambda: verify_redundancy(checked.system, independent_names, regular, starts, self._seed), OUT_OF_TIME
        )
        if names or found.verdict is not Verdict.AGREES:
            yield verdict_on(place, item, found)

    def _on_scene(self, place: Place, checked: CheckedScene) -> Iterator[EquationVerdict]:
        size, closed = checked.derivation.size, checked.derivation.closed
        law = bool(checked.premises.control_law)
        if closed:
            accelerations = [each for each in checked.derivation.equations if each.id == "accelerations"]
            size = length_of(accelerations[0]) if accelerations else 0
        series = closed and size <= self._limit
        items = scene_items(closed, series, law)
        yield from self._on_equations(place, checked.scene, items, checked, initial_motion.COMPARISONS)
        numbers = scene_numbers_left_out(closed, series, law)
        yield from self._on_left_out(place, checked.scene.left_out, numbers, size)
        yield from _left_out(place, checked.scene.left_out)

    def _on_equations(
        self,
        place: Place,
        part: Derivation | Scene,
        items: Sequence[Item],
        checked: Checked,
        comparisons: Mapping[str, Compare[Checked]],
    ) -> Iterator[EquationVerdict]:
        """Return verdicts on the equations of a part.

        Each of them must be there once, in its place and under its names.
        """
        waiting = list(items)
        for equation in part.equations:
            item = Item(equation.id, equation.number, equation.name)
            if item in waiting:
                waiting = waiting[waiting.index(item) + 1 :]
                compare = comparisons[equation.id]
                yield self._verify(place, item, lambda c=compare, e=equation: c(checked, e.relations), checked.system)
            else:
                reason = translatable("no such equation belongs here; or it is there twice, or out of order")
                yield _rejected(place, item, reason)
        recorded = {(each.id, each.number, each.name) for each in part.equations}
        for item in items:
            if item not in recorded:
                reason = translatable("the record does not contain this equation")
                yield _rejected(place, item, reason, is_recorded=False)

    def _verify(
        self,
        place: Place,
        item: Item,
        compare: Callable[[], Comparison | tuple[Comparison, ...]],
        system: MechanicalSystem,
    ) -> EquationVerdict:
        def work() -> CheckResult:
            try:
                compared = compare()
            except NotComparable as error:
                reason = translatable("the record contains %(reason)s", reason=error.reason)
                return CheckResult(Verdict.DISAGREES, None, None, reason)
            compared = (compared,) if isinstance(compared, Comparison) else compared
            comparisons = [replace(each, domain=system.terms) for each in compared]
            return verify_all(comparisons, f"{self._seed} {item.number} {item.name}")

        return verdict_on(place, item, self._time.result(work, OUT_OF_TIME))

    def _on_left_out(
        self, place: Place, left_out: LeftOut | None, numbers: Sequence[str], size: float
    ) -> Iterator[EquationVerdict]:
        predicted = None if math.isinf(size) else size
        expected = LeftOut(tuple(numbers), predicted, self._limit) if numbers else None
        if left_out != expected:
            detail = translatable(
                "the record has %(recorded)s, where %(expected)s belongs",
                recorded=_in_words(left_out),
                expected=_in_words(expected),
            )
            yield _rejected(place, Item("left_out", "", translatable("what is left out")), detail)


def _as_verdict(difference: Difference) -> EquationVerdict:
    place = Place(0, difference.scene)
    return _rejected(place, Item("description", "", difference.what), difference.detail, is_recorded=False)


def _redundant_in_words(redundant: Sequence[str]) -> str:
    if not redundant:
        return translatable("constraints that follow from the others: none")
    return translatable("constraints that follow from the others: those of %(names)s", names=", ".join(redundant))


def _rejected(place: Place, item: Item, reason: str, is_recorded: bool = True) -> EquationVerdict:
    return verdict_on(place, item, CheckResult(Verdict.DISAGREES, None, None, reason), is_recorded=is_recorded)


def _in_words(left_out: LeftOut | None) -> str:
    if left_out is None:
        return translatable("nothing")
    numbers, size, limit = left_out
    return translatable(
        "%(numbers)s of size %(size)s over %(limit)s", numbers=", ".join(numbers), size=size, limit=limit
    )


def _left_out(place: Place, left_out: LeftOut | None) -> Iterator[EquationVerdict]:
    nothing = CheckResult(Verdict.LEFT_OUT, None, None)
    for number in left_out.numbers if left_out else ():
        yield verdict_on(
            place, Item("", number, translatable("(not made)")), nothing, is_recorded=False, left_out=left_out
        )
