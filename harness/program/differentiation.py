"""Directional derivatives of a program, as a program that computes both.

Forward differentiation, assignment by assignment (Griewank & Walther, Evaluating Derivatives, 2nd ed., section 3.2).
"""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import partial
from itertools import islice

from .arithmetic import Arithmetic, run_program
from .motion_program import (
    CALLED,
    Atom,
    Constant,
    Expression,
    Name,
    Operation,
    Program,
    expression_of,
)
from .rewriting import ONE, ZERO
from .tape import Tape

Seeds = Mapping[str, Mapping[str, Atom]]
TWO = Fraction(2)


def derivative_name(name: str, direction: str) -> str:
    """Return the name of a derivative, ``d(x, m)``.

    Parameters
    ----------
    name : str
        Quantity to differentiate.
    direction : str
        Name of the direction, such as a parameter.

    Returns
    -------
    str
    """
    return f"d({name}, {direction})"


def differentiated(program: Program, seeds: Seeds) -> Program:
    """Return a program that also computes derivatives of the outputs.

    Parameters
    ----------
    program : Program
        The program to differentiate.
    seeds : mapping
        Input, then direction, to the derivative of this input in this direction. What is missing is zero. Names in it
        are inputs of the new program, behind those of the old one.

    Returns
    -------
    Program
        Outputs as before, then ``d(output, direction)`` for each output and direction. Zero is the number 0. A sign
        counts as constant.
    """
    tape = Tape({*program.inputs, *(name for name, _ in program.assignments)})
    found = run_program(
        program, {name: _Dual(Name(name), seeds.get(name, {})) for name in program.inputs}, _duals(tape)
    )
    return _written(program, tape, found, seeds)


def _written(program: Program, tape: Tape, found: Mapping[str, "_Dual"], seeds: Seeds) -> Program:
    """Return the program on a tape. Names in the seeds are inputs behind the others."""
    directions = dict.fromkeys(direction for each in seeds.values() for direction in each)
    named = (atom.text for each in seeds.values() for atom in each.values() if isinstance(atom, Name))
    derivatives = {
        derivative_name(output, direction): dual.rates.get(direction, ZERO)
        for output, dual in found.items()
        for direction in directions
    }
    return replace(
        program,
        inputs=tuple(dict.fromkeys((*program.inputs, *named))),
        assignments=tape.assignments,
        outputs={output: dual.value for output, dual in found.items()} | derivatives,
    )


def solution_differentiated(response: Program, matrices: Program, seeds: Seeds) -> Program:
    """Return a program of accelerations and multipliers with their derivatives.

    The derivatives solve the equations of motion with other right sides,

        A a' - J^T lambda' = h' - A' a + J'^T lambda,    J a' = -(c' + J' a),

    so the factors are not differentiated (M. Giles, Collected matrix derivative results for forward and reverse mode
    algorithmic differentiation, 2008).

    Parameters
    ----------
    response : Program
        Its inputs are those of the matrices, the n changes of h and the g changes of c, these in order. Its outputs are
        the accelerations, the multipliers, then the changes of both.
    matrices : Program
        With the outputs ``A[s,k]``, ``h[s]``, ``J[b,s]``, ``c[b]``.
    seeds : mapping
        As for `differentiated`.

    Returns
    -------
    Program
        As `differentiated` returns it.
    """
    tape = Tape({*response.inputs, *(name for each in (response, matrices) for name, _ in each.assignments)})
    arithmetic, changes = _duals(tape), [name for name in response.inputs if name not in matrices.inputs]
    here = {name: _Dual(Name(name)) for name in matrices.inputs}
    solved = run_program(response, here | dict.fromkeys(changes, _Dual(ZERO)), arithmetic)
    solution = dict(islice(solved.items(), len(changes)))
    moving = {name: _Dual(Name(name), seeds.get(name, {})) for name in matrices.inputs}
    sides = _right_sides(tape, run_program(matrices, moving, arithmetic), [dual.value for dual in solution.values()])
    moved = run_program(response, here | dict(zip(changes, sides, strict=True)), arithmetic)
    rates = [dual.rates for dual in islice(moved.values(), len(changes), None)]
    found = {name: _Dual(dual.value, own) for (name, dual), own in zip(solution.items(), rates, strict=True)}
    return _written(matrices, tape, found, seeds)


def _right_sides(tape: Tape, terms: Mapping[str, "_Dual"], solution: Sequence[Atom]) -> list["_Dual"]:
    """Return h' - A' a + J'^T lambda and c' + J' a, as changes of zero."""
    n = sum(name.startswith("h[") for name in terms)
    rows: list[list[_Dual]] = [[_Dual(ZERO)] for _ in solution]

    def add(row: int, dual: _Dual, weight: Atom) -> None:
        rows[row].append(_Dual(ZERO, _scaled(tape, dual, lambda: weight)))

    for name, dual in terms.items():
        match [int(part) - 1 if part.isdigit() else part for part in re.findall(r"\w+", name)]:
            case "A", s, k:
                add(s, dual, tape(Operation.NEGATE, solution[k]))
            case "h", s:
                add(s, dual, ONE)
            case "J", beta, s:
                add(s, dual, solution[n + beta])
                add(n + beta, dual, solution[s])
            case "c", beta:
                add(n + beta, dual, ONE)
    return [_sum(tape, *row) for row in rows]


@dataclass(frozen=True)
class _Dual:
    """A value, and its derivative in each direction in which it has one."""

    value: Atom
    rates: Mapping[str, Atom] = field(default_factory=dict)


SLOPES = {Operation(each.head): expression_of(each.slope) for each in CALLED if each.slope is not None}
SLOPES |= {Operation.NEGATE: -ONE}
"""Derivatives of functions of one argument, of the argument x and of the value y."""


def _duals(tape: Tape) -> Arithmetic[_Dual]:
    """Return the arithmetic of values with their derivatives."""
    special = {
        Operation.ADD: _sum,
        Operation.SUBTRACT: _difference,
        Operation.MULTIPLY: _product,
        Operation.DIVIDE: _quotient,
        Operation.POWER: _general_power,
        Operation.ARCTAN2: _angle,
    }
    functions = {operation: _function(tape, operation, slope) for operation, slope in SLOPES.items()}
    return Arithmetic(
        number=_Dual,
        constants={each: _Dual(each) for each in Constant},
        power=lambda base, exponent: _power(tape, base, exponent),
        operations=functions | {operation: _on(tape, rule) for operation, rule in special.items()},
    )


def _on(tape: Tape, rule: Callable[..., _Dual]) -> Callable[..., _Dual]:
    return lambda *arguments: rule(tape, *arguments)


def _function(tape: Tape, operation: Operation, slope: Expression) -> Callable[[_Dual], _Dual]:
    atoms = Arithmetic(
        number=lambda number: number,
        constants={each: each for each in Constant},
        power=tape.power,
        operations={each: partial(tape, each) for each in Operation},
    )

    def dual(x: _Dual) -> _Dual:
        value = tape(operation, x.value)
        return _Dual(value, _scaled(tape, x, lambda: atoms.value(slope, {"x": x.value, "y": value})))

    return dual


def _scaled(tape: Tape, x: _Dual, slope: Callable[[], Atom]) -> Mapping[str, Atom]:
    """Return the derivatives of a function of one value, given its slope.

    The slope is only evaluated if it is needed.
    """
    if not x.rates:
        return {}
    factor = slope()
    return {} if factor == ZERO else {k: tape.product(factor, rate) for k, rate in x.rates.items()}


def _in_any(*duals: _Dual) -> Iterable[str]:
    return dict.fromkeys(direction for each in duals for direction in each.rates)


def _sum(tape: Tape, *terms: _Dual) -> _Dual:
    rates = {k: tape.sum(term.rates[k] for term in terms if k in term.rates) for k in _in_any(*terms)}
    return _Dual(tape.sum(term.value for term in terms), rates)


def _difference(tape: Tape, a: _Dual, b: _Dual) -> _Dual:
    rates = {k: tape(Operation.SUBTRACT, a.rates.get(k, ZERO), b.rates.get(k, ZERO)) for k in _in_any(a, b)}
    return _Dual(tape(Operation.SUBTRACT, a.value, b.value), rates)


def _product(tape: Tape, *factors: _Dual) -> _Dual:
    values = [factor.value for factor in factors]
    others = [values[:place] + values[place + 1 :] for place in range(len(values))]
    rates = {
        k: tape.sum(
            tape.product(*rest, factor.rates[k])
            for rest, factor in zip(others, factors, strict=True)
            if k in factor.rates
        )
        for k in _in_any(*factors)
    }
    return _Dual(tape.product(*values), rates)


def _quotient(tape: Tape, a: _Dual, b: _Dual) -> _Dual:
    value = tape(Operation.DIVIDE, a.value, b.value)
    rates = {}
    for k in _in_any(a, b):
        change = a.rates.get(k, ZERO)
        if k in b.rates:
            change = tape(Operation.SUBTRACT, change, tape.product(value, b.rates[k]))
        rates[k] = tape.quotient(change, b.value)
    return _Dual(value, rates)


def _power(tape: Tape, base: _Dual, exponent: Fraction) -> _Dual:
    slope = _scaled(tape, base, lambda: tape.product(exponent, tape.power(base.value, exponent - 1)))
    return _Dual(tape.power(base.value, exponent), slope)


def _general_power(tape: Tape, base: _Dual, exponent: _Dual) -> _Dual:
    """Differentiate b^e: e b^(e - 1) b' + b^e ln(b) e'."""
    value = tape(Operation.POWER, base.value, exponent.value)

    def by_base() -> Atom:
        less = tape(Operation.POWER, base.value, tape(Operation.SUBTRACT, exponent.value, ONE))
        return tape.product(exponent.value, less)

    parts = (
        _scaled(tape, base, by_base),
        _scaled(tape, exponent, lambda: tape.product(value, tape(Operation.LN, base.value))),
    )
    return _Dual(value, {k: tape.sum(part[k] for part in parts if k in part) for k in _in_any(base, exponent)})


def _angle(tape: Tape, y: _Dual, x: _Dual) -> _Dual:
    """Differentiate atan2(y, x): (x y' - y x')/(x^2 + y^2)."""
    square = tape.sum([tape.power(x.value, TWO), tape.power(y.value, TWO)])
    change = _difference(tape, *(
        _Dual(ZERO, _scaled(tape, moving, lambda by=by: by.value)) for moving, by in ((y, x), (x, y))
    ))  # fmt: skip
    rates = {k: tape.quotient(rate, square) for k, rate in change.rates.items()}
    return _Dual(tape(Operation.ARCTAN2, y.value, x.value), rates)


def along(names: Iterable[str], directions: Iterable[str]) -> dict[str, dict[str, Expression]]:
    """Return seeds for quantities whose directional derivatives are inputs.

    Parameters
    ----------
    names : iterable of str
        Inputs of a program.
    directions : iterable of str
        Names of the directions.

    Returns
    -------
    dict of str to dict of str to Expression
        Seeds for `differentiated`: input, then direction, to a name such as ``d(x, m)``.
    """
    directions = tuple(directions)
    return {name: {k: Name(derivative_name(name, k)) for k in directions} for name in names}
