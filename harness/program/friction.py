"""Amounts of friction, and the linear equations that they satisfy.

A sign s_j in forces has an amount y_j: the sign itself, or s_j size_j if these forces contain multipliers. The
accelerations under given amounts are affine in them (`maxima/program/reacting_forces.mac`), and so are

    drive_j        the first derivative of the switching function that contains accelerations,
    size_j         the largest amount,
    reaction_k     the multipliers whose signs forces contain.

A motion slides on switching surfaces with the amounts of drive_j = 0. These may depend on each other: the contacts of
a ladder stick together, and their amounts are not unique. Then one slides, and the others take all their friction.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from .differentiation import derivative_name, differentiated
from .motion_problem import MotionProblem
from .motion_program import Atom, Call, Name, Operation, Program, names_used
from .rewriting import ONE, ZERO, computing, with_calls, with_numbers
from .tape import Tape

SLIDING = "sliding"  # in a pattern, the sign that makes the motion slide on its switching surface
STUCK = {"stuck 1": 1, "stuck -1": -1}  # signs that stick with the sliding one, at their full friction
Pattern = Mapping[str, int | str]
Row = list[Atom]


def unknown_amounts(problem: MotionProblem, zeros: Collection[str]) -> tuple[str, ...]:
    """Return the signs whose amounts the equations determine.

    Parameters
    ----------
    problem : MotionProblem
        A motion with signs.
    zeros : collection of str
        Signs of the switching surfaces on which the motion is.

    Returns
    -------
    tuple of str
        Those, and the ones with multipliers in their sizes.
    """
    outputs = problem.switching.outputs
    return tuple(name for name, place in problem.places.items() if name in zeros or f"size[{place}]" in outputs)


def sticking(pattern: Pattern) -> list[str]:
    """Return the signs of the switching functions that remain zero.

    Parameters
    ----------
    pattern : Pattern

    Returns
    -------
    list of str
        Those that slide or are stuck.
    """
    return [name for name, value in pattern.items() if isinstance(value, str)]


def numbers_in(pattern: Pattern) -> dict[str, Fraction]:
    """Return the signs that are numbers.

    Parameters
    ----------
    pattern : Pattern

    Returns
    -------
    dict of str to Fraction
    """
    return {name: Fraction(STUCK.get(value, value)) for name, value in pattern.items() if value != SLIDING}


def with_sizes(program: Program, pattern: Pattern, zeros: Collection[str]) -> Program:
    """Return a program with the sizes of switching functions.

    |g| is ``sign(s) g`` where forces are not linear in the sign s otherwise. It is zero while g remains zero.

    Parameters
    ----------
    program : Program
        A program with signs.
    pattern : Pattern
        The values of the signs.
    zeros : collection of str
        Signs of the switching functions that remain zero.

    Returns
    -------
    Program
    """
    numbers = numbers_in(pattern) | dict.fromkeys(zeros, ZERO)
    known = {Call(Operation.SIGN, (Name(name),)): number for name, number in numbers.items()}
    return with_calls(program, known)


def affine_terms(
    problem: MotionProblem, pattern: Pattern, zeros: Collection[str], unknown: Collection[str]
) -> Program | None:
    """Return constants and slopes of quantities that are affine in amounts.

    Parameters
    ----------
    problem : MotionProblem
        A motion with signs.
    pattern : Pattern
        The values of the other signs.
    zeros : collection of str
        Signs whose drives are wanted.
    unknown : collection of str
        As `unknown_amounts` returns them.

    Returns
    -------
    Program or None
        Outputs ``drive[j]`` of the zeros, ``size[j]``, ``reaction[k]`` and ``regular``, each where the amounts are
        zero, and ``d(output, sign)`` for each amount. None if a drive, size or reaction is not affine.
    """
    wanted = {f"drive[{problem.places[name]}]" for name in zeros}
    wanted |= {name for name in problem.switching.outputs if name.startswith(("size[", "reaction[", "regular"))}
    given = {name: number for name, number in numbers_in(pattern).items() if name not in unknown}
    program = with_sizes(computing(problem.switching, wanted), pattern, zeros)
    program = with_numbers(program, given)
    both = _with_slopes(program, unknown)
    return None if both is None else with_numbers(both, dict.fromkeys(unknown, ZERO))


def _with_slopes(program: Program, names: Collection[str]) -> Program | None:
    """Return a program with derivatives by inputs, or None if it is not affine."""
    both = differentiated(program, {name: {name: ONE} for name in names})
    slopes = computing(both, both.outputs.keys() - program.outputs.keys())
    return both if names_used(slopes).isdisjoint(names) else None


def slides(problem: MotionProblem, name: str) -> bool:
    """Return True if a motion can slide on a switching surface with a drive.

    It cannot if multipliers stand in its forces in several directions.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    name : str
        One of its signs.

    Returns
    -------
    bool
    """
    ones = {sign.name: 1 for sign in problem.signs}
    return affine_terms(problem, ones, {name}, unknown_amounts(problem, {name})) is not None


def curved_forces(problem: MotionProblem, pattern: Pattern, zeros: Collection[str]) -> tuple[Program, list[str]] | None:
    """Return the forces that are not affine in signs whose amounts they are.

    Parameters
    ----------
    problem : MotionProblem
        A motion with signs.
    pattern : Pattern
        The values of the other signs.
    zeros : collection of str
        Signs of the switching surfaces on which the motion is.

    Returns
    -------
    tuple of Program and list of str, or None
        Outputs ``h[s]`` and the signs, its last inputs. None if the forces are affine for all states.
    """
    outputs = problem.switching.outputs
    names = [name for name, place in problem.places.items() if name in zeros and f"size[{place}]" not in outputs]
    if not names:
        return None
    forces = computing(problem.matrices, {output for output in problem.matrices.outputs if output.startswith("h[")})
    given = {name: number for name, number in numbers_in(pattern).items() if name not in names}
    others = dict.fromkeys(problem.places.keys() - given.keys() - set(names), ONE)
    forces = with_numbers(with_sizes(forces, pattern, zeros), given | others)
    if _with_slopes(forces, names) is not None:
        return None
    return replace(forces, inputs=(*(name for name in forces.inputs if name not in names), *names)), names


def sliding_signs(problem: MotionProblem, pattern: Pattern) -> Program:
    """Return the program of the signs that slide.

    Parameters
    ----------
    problem : MotionProblem
        A motion with signs.
    pattern : Pattern
        The sign of each function.

    Returns
    -------
    Program
        An output by the name of each sliding sign: y_j/size_j, from drive_j = 0 if it slides, from y_j = s_j size_j
        otherwise.
    """
    zeros = [name for name, value in pattern.items() if value == SLIDING]
    unknown = unknown_amounts(problem, zeros)
    terms = affine_terms(problem, pattern, zeros, unknown)
    tape = Tape({*terms.inputs, *(name for name, _ in terms.assignments), *pattern})
    equations = _Equations(terms, problem.places, unknown, tape)
    numbers = numbers_in(pattern)
    amounts = _solved([equations.row(name, numbers.get(name)) for name in unknown], tape)
    signs = [(name, equations.share(name, amounts)) for name in zeros]
    outputs = {name: Name(name) for name in zeros}
    whole = replace(terms, assignments=(*terms.assignments, *tape.assignments, *signs), outputs=outputs)
    return computing(whole, outputs)


class _Equations:
    """The linear equations of the amounts, written on a tape."""

    def __init__(self, terms: Program, places: Mapping[str, int], unknown: Sequence[str], tape: Tape) -> None:
        self._terms, self._places, self._unknown, self._tape = terms.outputs, places, unknown, tape

    def _affine(self, quantity: str, name: str, otherwise: Fraction) -> Row:
        """Return the slopes of a quantity, then its constant."""
        output = f"{quantity}[{self._places[name]}]"
        slopes = [self._terms.get(derivative_name(output, other), ZERO) for other in self._unknown]
        return [*slopes, self._terms.get(output, otherwise)]

    def row(self, name: str, sign: Fraction | None) -> Row:
        """Return the coefficients of a sign's equation, then the right side.

        The sign is None if it slides.
        """
        if sign is None:
            *slopes, constant = self._affine("drive", name, ZERO)
            return [*(self._tape(Operation.NEGATE, slope) for slope in slopes), constant]
        *slopes, constant = (self._tape.product(sign, term) for term in self._affine("size", name, ONE))
        own = [ONE if other == name else ZERO for other in self._unknown]
        return [*(self._tape(Operation.SUBTRACT, *pair) for pair in zip(own, slopes, strict=True)), constant]

    def share(self, name: str, amounts: Sequence[Atom]) -> Atom:
        """Return the share that an amount has of its size: the sign."""
        *slopes, constant = self._affine("size", name, ONE)
        terms = (self._tape.product(slope, y) for slope, y in zip(slopes, amounts, strict=True))
        return self._tape.quotient(amounts[self._unknown.index(name)], self._tape.sum([constant, *terms]))


def _solved(rows: list[Row], tape: Tape) -> list[Atom]:
    """Return the solution of linear equations by elimination.

    No pivot vanishes where accelerations are unique: the leading minors have the sign of the determinants of modes.
    """

    def less(a: Atom, factor: Atom, b: Atom) -> Atom:
        return tape(Operation.SUBTRACT, a, tape.product(factor, b))

    for k, pivot in enumerate(rows):
        for row in rows[k + 1 :]:
            factor = tape.quotient(row[k], pivot[k])
            row[k + 1 :] = [less(a, factor, b) for a, b in zip(row[k + 1 :], pivot[k + 1 :], strict=True)]
    found: list[Atom] = []
    for k, (*row, right) in reversed(list(enumerate(rows))):
        for entry, value in zip(row[k + 1 :], found, strict=True):
            right = less(right, entry, value)
        found.insert(0, tape.quotient(right, row[k]))
    return found
