"""Choose times for the comparison of control laws.

They lie on each polynomial of a table, and on both sides of each switch.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations, pairwise

from mpmath import mp

from ..expression.trees import Tree
from ..program.motion_problem import DependsOn, MotionProblem
from .described_motion import DescribedMotion
from .irregular_point import IrregularPoint
from .law import Law
from .program_values import run
from .taylor import Taylor

SAMPLES = 199  # times between which the sign of a switching function is looked for
BISECTIONS = 60
BESIDE = mp.mpf(10) ** -6  # of the time span: how far from a switch the laws are compared
SWITCHES = ("UnitStep", "HalfStep", "Sign", "Abs")

Functions = Callable[[mp.mpf], Sequence[mp.mpf]]


def law_times(motion: DescribedMotion, problem: MotionProblem, span: tuple[mp.mpf, mp.mpf]) -> Iterator[mp.mpf]:
    """Yield times within a span, one on each part of a law and two at each boundary.

    Parameters
    ----------
    motion : DescribedMotion
        A motion with switches and tables.
    problem : MotionProblem
        A problem with further ones.
    span : tuple of mpf
        First and last time.

    Yields
    ------
    mpf
        Time, in the scene's unit.
    """
    first, last = span
    breaks = [*_knots(motion, problem), *_zeros(_stated(motion), span), *_zeros(_derived(problem), span)]
    inside = sorted({each for each in breaks if first < each < last})
    yield from ((a + b) / 2 for a, b in pairwise([first, *inside, last]))
    for each in inside:
        yield from (x for x in (each - BESIDE * (last - first), each + BESIDE * (last - first)) if first < x < last)


def _knots(motion: DescribedMotion, problem: MotionProblem) -> Iterator[mp.mpf]:
    for spline in motion.splines:
        yield from spline.times
    for table in problem.tables:
        yield from (mp.mpf(begin.numerator) / begin.denominator for begin in table.begins)


def _stated(motion: DescribedMotion) -> Functions:
    trees = [*motion.scene.control_law.trees.values(), *motion.scene.prescribed_reactions.trees.values()]
    functions = dict(enumerate(function for tree in trees for function in switching_functions(tree)))
    law = Law({str(place): function for place, function in functions.items()}, motion.splines)
    parameters = motion.parameters()
    return lambda time: [value[0] for value in law.at(Taylor(0), time, parameters).values()]


def switching_functions(tree: Tree) -> Iterator[Tree]:
    """Yield the functions whose signs decide the form of an expression.

    Parameters
    ----------
    tree : Tree
        The expression.

    Yields
    ------
    Tree
        A function, as a tree.
    """
    match tree:
        case ["Which", *parts]:
            for condition in parts[::2]:
                yield from _compared(condition)
        case ["Max" | "Min", *parts]:
            yield from (["Subtract", a, b] for a, b in combinations(parts, 2))
        case [str(head), argument] if head in SWITCHES:
            yield argument
    if isinstance(tree, list):
        for part in tree[1:]:
            yield from switching_functions(part)


def _compared(condition: Tree) -> Iterator[Tree]:
    match condition:
        case ["And" | "Or" | "Not", *parts]:
            for part in parts:
                yield from _compared(part)
        case [str(), a, b]:
            yield ["Subtract", a, b]


def _derived(problem: MotionProblem) -> Functions:
    of_time = [f"switch[{place}]" for place, sign in enumerate(problem.signs, 1) if sign.by is DependsOn.TIME]
    signs = {sign.name: (mp.one,) for sign in problem.signs}

    def values(time: mp.mpf) -> list[mp.mpf]:
        if not of_time:
            return []
        known = dict.fromkeys(problem.switching.inputs, (mp.one,)) | signs | {"t": (time,)}
        found = run(problem.switching, known)
        return [found[name][0] for name in of_time]

    return values


def _zeros(functions: Functions, span: tuple[mp.mpf, mp.mpf]) -> Iterator[mp.mpf]:
    """Return the times at which one of some functions changes its sign."""
    first, last = span

    def signs(time: mp.mpf) -> list[mp.mpf] | None:
        try:
            return [mp.sign(value) for value in functions(time)]
        except (IrregularPoint, ZeroDivisionError, OverflowError):
            return None

    grid = [first + (last - first) * mp.mpf(k) / SAMPLES for k in range(SAMPLES + 1)]
    if signs(grid[0]) == []:
        return
    for (a, before), (b, after) in pairwise((each, signs(each)) for each in grid):
        for i, (of_a, of_b) in enumerate(zip(before or (), after or (), strict=False)):
            if of_a != of_b:
                yield _bisected(signs, i, a, b)


def _bisected(signs: Callable[[mp.mpf], list[mp.mpf] | None], i: int, a: mp.mpf, b: mp.mpf) -> mp.mpf:
    """Return the time between two at which a function changes its sign."""
    of_a = signs(a)[i]
    for _ in range(BISECTIONS):
        middle = (a + b) / 2
        found = signs(middle)
        if found is None:
            return middle
        a, b = (middle, b) if found[i] == of_a else (a, middle)
    return b
