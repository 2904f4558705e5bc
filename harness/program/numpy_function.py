"""A motion program as a NumPy function over arrays of points.

The program becomes the source of a Python function. No text of the document is read as code: names are replaced, and
numbers are written anew. Evaluation of the program ufunc by ufunc takes six times as long for one point (measured on a
chain of 64 masses). A variable is reused when its value is no longer needed, and large arrays are cut into blocks that
stay in the cache. Each saves a third of the time.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import partial
from math import e, pi
from types import CodeType, FunctionType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arithmetic import ELEMENTARY, Arithmetic
from .motion_program import Constant, Name, Operation, Program, calls_of, names_in

BLOCK = 4096  # points carried through the program at a time; the fastest of 256, 1024, 4096 and 16384 as measured

OF_SCIPY = {Operation.ERF: ELEMENTARY[Operation.ERF]}  # ufuncs of scipy.special, loaded where a program calls one
UFUNCS = {operation: getattr(np, name) for operation, name in ELEMENTARY.items() if operation not in OF_SCIPY}
UFUNC_NAMES = {ufunc.__name__: ufunc for ufunc in (*UFUNCS.values(), np.square, np.power)}
IN_SPAN = {"where": np.where, "nan": np.nan}  # what bounds the time


class NumpyFunction:
    """A motion program over arrays."""

    def __init__(self, program: Program) -> None:
        self.inputs = program.inputs
        self.outputs = tuple(program.outputs)
        self._program, self._run = program, _compiled(program)

    def __reduce__(self) -> tuple[type["NumpyFunction"], tuple[Program]]:
        return NumpyFunction, (self._program,)

    def __call__(self, inputs: Sequence[ArrayLike]) -> NDArray[np.float64]:
        """Evaluate the program at each point.

        Parameters
        ----------
        inputs : sequence of array_like
            One array or number for each input of the program. They are broadcast against each other to the shape of
            the points.

        Returns
        -------
        ndarray, shape (outputs, *points)
            Where the program's pivots vanish, infinities and nans.

        Raises
        ------
        ValueError
            There are more or fewer inputs.
        """
        if len(inputs) != len(self.inputs):
            raise ValueError(f"{len(self.inputs)} inputs needed, not {len(inputs)}")
        arrays = np.broadcast_arrays(*(np.asarray(values, dtype=float) for values in inputs))
        return self.at_points([array.reshape(-1) for array in arrays]).reshape(len(self.outputs), *arrays[0].shape)

    def at_points(self, inputs: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
        """Evaluate the program at k points.

        Parameters
        ----------
        inputs : sequence of ndarray, each of shape (k,)
            One array for each input of the program.

        Returns
        -------
        ndarray, shape (outputs, k)
        """
        result = np.empty((len(self.outputs), len(inputs[0])))
        with np.errstate(all="ignore"):
            for start in range(0, result.shape[1], BLOCK):
                block = slice(start, start + BLOCK)
                for row, values in zip(result, self._run([array[block] for array in inputs]), strict=True):
                    row[block] = values
        return result


def needs_scipy(program: Program) -> bool:
    """Return True if a program calls functions that NumPy does not have.

    Parameters
    ----------
    program : Program

    Returns
    -------
    bool
    """
    return any(call.operation in OF_SCIPY for call in calls_of(program))


def _compiled(program: Program) -> Callable[[Sequence[NDArray[np.float64]]], list[ArrayLike]]:
    source = "\n ".join(["def motion(inputs):", *_statements(program)])
    module = compile(source, "<motion program>", "exec")
    code = next(constant for constant in module.co_consts if isinstance(constant, CodeType))
    return FunctionType(code, UFUNC_NAMES | IN_SPAN | _called_of_scipy(code.co_names))


def _called_of_scipy(names: Sequence[str]) -> Mapping[str, np.ufunc]:
    """Return the ufuncs of scipy.special among the names that a function uses."""
    called = [name for name in names if name in OF_SCIPY.values()]
    if not called:
        return {}
    from scipy import special

    return {name: getattr(special, name) for name in called}


def _statements(program: Program) -> Iterator[str]:
    """Yield assignments to few variables, v0, v1, ....

    A variable is reused after the last use of its value.
    """
    variables = {name: f"v{index}" for index, name in enumerate(program.inputs)}
    yield f"[{', '.join(variables.values())}] = inputs"
    if program.law_span is not None:
        yield "{0} = where(({0} >= {1}) & ({0} <= {2}), {0}, nan)".format(variables["t"], *program.times)
    last_use, free, taken = _last_uses(program), [], len(variables)
    for index, (name, expression) in enumerate(program.assignments):
        used = names_in(expression)
        formula = SOURCE.value(expression, variables)
        free += [variables[known] for known in sorted(used) if last_use[known] == index]
        if not free:
            free.append(f"v{taken}")
            taken += 1
        variables[name] = free.pop()
        yield f"{variables[name]} = {formula}"
    yield f"return [{', '.join(SOURCE.atom(value, variables) for value in program.outputs.values())}]"


def _last_uses(program: Program) -> Mapping[str, int]:
    """Return the index of the last assignment that uses each value.

    It is past the end for outputs.
    """
    uses = {used: index for index, (_, expression) in enumerate(program.assignments) for used in names_in(expression)}
    until_end = {value.text: len(program.assignments) for value in program.outputs.values() if isinstance(value, Name)}
    return uses | until_end


def _number(value: Fraction | float) -> str:
    return repr(float(value)) if value >= 0 else f"({float(value)!r})"


def _call(function: str, *arguments: str) -> str:
    return f"{function}({', '.join(arguments)})"


def _chained(operator: str, *arguments: str) -> str:
    """Combine terms in pairs, and these pairs in pairs.

    A sum of thousands of terms becomes a formula of a dozen levels, which Python can compile.
    """
    if len(arguments) == 1:
        return arguments[0]
    middle = len(arguments) - len(arguments) // 2
    return f"({_chained(operator, *arguments[:middle])} {operator} {_chained(operator, *arguments[middle:])})"


def _power(base: str, exponent: Fraction) -> str:
    if exponent < 0:
        return f"(1.0 / {_power(base, -exponent)})"
    match exponent:
        case 1:
            return base
        case 2:
            return _call("square", base)
        case _ if exponent == Fraction(1, 2):
            return _call("sqrt", base)
        case _:
            return _call("power", base, _number(exponent))


SOURCE = Arithmetic(
    number=_number,
    constants={Constant.PI: _number(pi), Constant.E: _number(e)},
    power=_power,
    operations={
        **{operation: partial(_call, ufunc.__name__) for operation, ufunc in UFUNCS.items()},
        **{operation: partial(_call, name) for operation, name in OF_SCIPY.items()},
        Operation.ADD: partial(_chained, "+"),
        Operation.MULTIPLY: partial(_chained, "*"),
        Operation.SUBTRACT: partial(_chained, "-"),
        Operation.DIVIDE: partial(_chained, "/"),
        Operation.NEGATE: lambda argument: f"(-{argument})",
        Operation.POWER: partial(_call, "power"),
    },
)
