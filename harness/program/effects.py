"""Operations and evaluation time of the terms of (3) and (7) and of the effects.

A term costs as much as a program of that term alone. The cost of an effect is the difference between the scene's
program and the program without it. For an absent effect, between the program with it and the scene's. A cost may be
negative, because an effect can change the order of elimination. A pair of switches costs the excess over the sum of
both.
"""

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from enum import StrEnum
from itertools import count
from pathlib import Path

import numpy as np

from ..documents import ask
from ..failures import ErrorKind, HolonomError
from ..formats import Document, read
from ..language import translatable
from ..sandbox import Limits
from ..shown import Shown
from ..source import Source
from ..structs import entry, with_attributes
from .c_function import compile_c
from .motion_program import Program
from .numpy_function import NumpyFunction
from .request import Request
from .timing import Batch, Timer, python_batch, shortest_times

GOLDEN = 0.6180339887498949  # its multiples are spread evenly over the fractions and satisfy no short relation
ATTEMPTS = 50  # points tried in search of one where the program's values are finite


class Status(StrEnum):
    """The presence of a term or an effect in a scene, or the reason of its absence."""

    PRESENT = translatable("present")
    ABSENT_BY_CHOICE = translatable("absent by choice")
    ABSENT_BY_STRUCTURE = translatable("absent by structure")


class Measure(StrEnum):
    """The compilation of the programs whose times were measured."""

    C = "C"
    NUMPY = "NumPy"


@dataclass(frozen=True)
class TermProgram:
    """A term of one of the paper's equations."""

    equation: str = entry("The equation number.")
    name: str = entry("Name of the term.", key="term")
    program: Program | None = entry("Program of the term, or null where there is none.")


@dataclass(frozen=True)
class EffectProgram:
    """An effect of the system."""

    name: str = entry("Name of the effect.")
    called: bool = entry("True if the scene calls for the effect.")
    otherwise: Program | None = entry("Program that differs in this effect, or null.")


@dataclass(frozen=True)
class PairProgram:
    """Two switches of the system."""

    names: tuple[str, str] = entry("Names of the two effects.", minItems=2)
    otherwise: Program | None = entry("Program that differs in both effects, or null.")


@dataclass(frozen=True)
class Costs:
    """The programs by which a scene's costs are found."""

    program: Program = entry("The scene's motion program.")
    terms: tuple[TermProgram, ...] = entry(
        "Each term of (3) and (7) as a program of its own, or null where it is absent by structure."
    )
    effects: tuple[EffectProgram, ...] = entry(
        "For each effect the program of the scene that differs in it alone, or null where there is none."
    )
    pairs: tuple[PairProgram, ...] = entry(
        "For each pair of switches the program of the scene that differs in both, or null where there is none.", ()
    )


@dataclass(frozen=True)
class TermCost:
    """The cost of a term, zero if it is absent."""

    equation: str = entry("The equation number.")
    term: str = entry("Name of the term.")
    status: Status = entry("Presence of the term.")
    operations: int = entry("Operations of the term.", minimum=0)
    seconds: float = entry("For one evaluation; 0 where the term is absent.", minimum=0)


@dataclass(frozen=True)
class EffectCost:
    """The additional cost of an effect or a pair of switches.

    It is None if the equations cannot be solved without or with it.
    """

    name: str = entry("Name of the effect.")
    status: Status = entry("Presence of the effect.")
    operations: int | None = entry(
        "Operations that it adds, or would add; null where nothing can be solved without it, or with it."
    )
    seconds: float | None = entry("The same in time, for one evaluation.")


@with_attributes
@dataclass(frozen=True, repr=False)
class MeasuredCosts(Shown):
    """The costs of a scene, in operations and in time for one evaluation."""

    scene: str | None = entry("null where the file holds a system alone.")
    operations: int = entry("Operations of the scene's motion program.", minimum=0)
    seconds_per_evaluation: float = entry(
        "Time for one evaluation of the motion program, the shortest measured.", exclusiveMinimum=0
    )
    measured_in: Measure = entry("Target of the compilation.")
    terms: tuple[TermCost, ...] = entry("Each term of (3) and (7).")
    effects: tuple[EffectCost, ...] = entry("Each effect of the system.")
    pairs: tuple[EffectCost, ...] = entry("Each pair of its switches, a*b: what both add beyond what each adds.", ())


def scene_costs(file: Source | Path, request: Request, limits: Limits) -> MeasuredCosts:
    """Return the costs of a scene, from programs that Maxima derives.

    Parameters
    ----------
    file : Source or Path
        Scene file.
    request : Request
        Scene, solve and settings.
    limits : Limits
        Limits of each run of Maxima.

    Returns
    -------
    MeasuredCosts
        Costs in operations and in seconds.

    Raises
    ------
    HolonomError
        As `holonom.documents.ask` and `measure_costs`.
    """
    asked = (Document.EFFECTS, file, request.scene, request.solve)
    text = ask(*asked, settings=request.settings, limits=limits)
    return _measure_costs(read(Document.EFFECTS, text, Costs))


def _measure_costs(costs: Costs) -> MeasuredCosts:
    """Count the operations of a scene's programs and measure their times at one point.

    The point is regular. Times are those of compiled C, or of NumPy without a C compiler.
    """
    programs = [costs.program, *(part.program for part in costs.terms if part.program is not None)]
    programs += [each.otherwise for each in (*costs.effects, *costs.pairs) if each.otherwise is not None]
    point = _regular_point(costs.program, dict.fromkeys(name for program in programs for name in program.inputs))
    measured_in, batches = _batches(programs, point)
    seconds = shortest_times(dict(zip(map(id, programs), batches, strict=True)))
    return MeasuredCosts(
        costs.program.scene,
        costs.program.operations,
        seconds[id(costs.program)],
        measured_in,
        tuple(_term_cost(term, seconds) for term in costs.terms),
        tuple(_effect_cost(effect, costs.program, seconds) for effect in costs.effects),
        tuple(_pair_cost(pair, costs, seconds) for pair in costs.pairs),
    )


def _term_cost(term: TermProgram, seconds: Mapping[int, float]) -> TermCost:
    if term.program is None:
        return TermCost(term.equation, term.name, Status.ABSENT_BY_STRUCTURE, 0, 0.0)
    return TermCost(term.equation, term.name, Status.PRESENT, term.program.operations, seconds[id(term.program)])


def _effect_cost(effect: EffectProgram, whole: Program, seconds: Mapping[int, float]) -> EffectCost:
    status = Status.PRESENT if effect.called else Status.ABSENT_BY_CHOICE
    if effect.otherwise is None:
        return EffectCost(effect.name, status, None, None)
    more, less = (whole, effect.otherwise) if effect.called else (effect.otherwise, whole)
    return EffectCost(effect.name, status, more.operations - less.operations, seconds[id(more)] - seconds[id(less)])


def _pair_cost(pair: PairProgram, costs: Costs, seconds: Mapping[int, float]) -> EffectCost:
    """With both, less with either one, and with neither."""
    one, other = (next(effect for effect in costs.effects if effect.name == name) for name in pair.names)
    name, status = "*".join(pair.names), Status.PRESENT if one.called and other.called else Status.ABSENT_BY_CHOICE
    alike, unlike = (costs.program, pair.otherwise), (one.otherwise, other.otherwise)
    if None in (*alike, *unlike):
        return EffectCost(name, status, None, None)
    more, less = (alike, unlike) if one.called == other.called else (unlike, alike)
    return EffectCost(
        name,
        status,
        sum(program.operations for program in more) - sum(program.operations for program in less),
        sum(seconds[id(program)] for program in more) - sum(seconds[id(program)] for program in less),
    )


def _batches(programs: Sequence[Program], point: Mapping[str, float]) -> tuple[Measure, list[Batch]]:
    given = [np.array([point[name] for name in program.inputs]) for program in programs]
    try:
        timer = Timer()
    except HolonomError as error:
        if error.kind is not ErrorKind.COMPILER_MISSING:
            raise
        return Measure.NUMPY, list(map(python_batch, map(NumpyFunction, programs), given))
    with ThreadPoolExecutor() as compilers:
        return Measure.C, list(map(timer.evaluation, compilers.map(compile_c, programs), given))


def _regular_point(program: Program, names: Mapping[str, None]) -> dict[str, float]:
    """Return the first point of a sequence at which the program's values are finite.

    The points have no symmetry.
    """
    evaluate = NumpyFunction(program)
    for point in _points(names):
        with np.errstate(all="ignore"):
            if np.all(np.isfinite(evaluate([point[name] for name in program.inputs]))):
                break
    return point


def _points(names: Mapping[str, None]) -> Iterator[dict[str, float]]:
    places = count(1)
    for _ in range(ATTEMPTS):
        yield {name: 0.5 + GOLDEN * place % 1 for name, place in zip(names, places, strict=False)}
