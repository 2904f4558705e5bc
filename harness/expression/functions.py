"""Functions and constants of expressions: names, derivatives and behaviour."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, auto
from functools import partial
from typing import Any


@dataclass(frozen=True)
class Constant:
    """A constant."""

    scene: str  # in scene files, as Maxima calls it
    latex: str
    sympy: str
    mpmath: str = ""  # empty where it is not a real number


# By the name in MathJSON.
CONSTANTS = {
    "Pi": Constant("%pi", r"\pi", "pi", "pi"),
    "ExponentialE": Constant("%e", "e", "E", "e"),
    "ImaginaryUnit": Constant("%i", "i", "I"),
    "EulerGamma": Constant("%gamma", r"\gamma", "EulerGamma", "euler"),
}


class Behaviour(Enum):
    """Behaviour of a function of a real argument."""

    PERIODIC = auto()
    CHANGING = auto()  # in a narrow range of the argument: it grows, or goes from one limit to another
    MODERATE = auto()


@dataclass(frozen=True, eq=False)
class Function:
    """A function.

    The derivative ``slope`` is a tree in the argument ``x`` and the value ``y``. The other argument is ``n`` if it is
    an order, else ``m``. ``value`` takes mpmath and the arguments, if mpmath has no function of that name.
    """

    head: str  # of a tree in MathJSON
    scene: str  # in scene files, as Maxima calls it
    latex: str = ""  # a command, or a name that is set upright; empty where a formula has a sign of its own
    program: str = ""  # in most of C, NumPy, JavaScript and heyoka; empty where programs do not call it
    slope: Any = None
    sympy: str = ""  # where SymPy, or `elliptic`, calls it otherwise than Maxima; mpmath mostly does the same
    arity: int = 1
    of_an_order: bool = False  # in formulas the first argument stands below
    behaviour: Behaviour = Behaviour.MODERATE
    special: bool = False  # mpmath needs a term or more for each unit of the argument; programs hold a polynomial
    value: Callable[..., Any] | None = None

    @property
    def in_sympy(self) -> str:
        """Name in SymPy or in `holonom.expression.elliptic`."""
        return self.sympy or self.scene

    @property
    def operator(self) -> str:
        """Name in LaTeX."""
        return self.latex if self.latex.startswith("\\") else rf"\operatorname{{{self.latex}}}"

    @property
    def arguments(self) -> tuple[str, ...]:
        """Names of the arguments in ``slope``."""
        return ("x",) if self.arity == 1 else ("n", "x") if self.of_an_order else ("x", "m")

    def of(self, mp: Any) -> Callable[..., Any]:
        """Return the function in mpmath.

        Parameters
        ----------
        mp : module
            The context of mpmath.

        Returns
        -------
        callable
            None is a missing value.
        """
        return partial(self.value, mp) if self.value else getattr(mp, self.in_sympy)


def _square(a: int, sign: int, of: str = "x") -> list:
    """Return a + z^2 or a - z^2."""
    return ["Add" if sign > 0 else "Subtract", a, ["Power", of, 2]]


def _over(below: Any, above: int = 1) -> list:
    return ["Divide", above, below]


def _root(below: Any, above: int = 1) -> list:
    return _over(["Sqrt", below], above)


def _bell(factor: int) -> list:
    return ["Multiply", factor, _root("Pi"), ["Exp", ["Negate", ["Power", "x", 2]]]]


def _times(*factors: Any) -> list:
    return ["Multiply", *factors]


def _real(name: str) -> Callable[..., Any]:
    """Return a function of mpmath that is one of real numbers alone."""
    return lambda mp, *x: None if any(map(mp.im, x)) else getattr(mp, name)(*x)


def _bessel(symbol: str, before: int, after: int) -> Function:
    """Return a Bessel function, given the signs of its neighbours in the derivative."""
    head = f"Bessel{symbol}"
    neighbours = (_times(before, [head, ["Add", "n", -1], "x"]), _times(after, [head, ["Add", "n", 1], "x"]))
    slope, name = ["Divide", ["Add", *neighbours], 2], symbol.lower()
    return Function(head, f"bessel_{name}", symbol, "", slope, f"bessel{name}", 2, of_an_order=True, special=True)


def _airy(symbol: str) -> tuple[Function, Function]:
    name, prime = f"airy{symbol}i", f"airy{symbol}iprime"
    head, scene, latex = f"Airy{symbol.upper()}i", f"airy_{symbol}i", f"{symbol.upper()}i"
    return (
        Function(head, scene, latex, "", [f"{head}Prime", "x"], name, special=True),
        Function(
            f"{head}Prime", f"airy_d{symbol}i", rf"\operatorname{{{latex}}}'", "", _times("x", [head, "x"]), prime,
            special=True, value=lambda mp, x: getattr(mp, name)(x, derivative=1),
        ),
    )  # fmt: skip


def _jacobi(name: str, factor: Any, *others: str) -> Function:
    """Return one of Jacobi's functions, given the factors of its derivative."""
    slope = _times(factor, *([f"Jacobi{each}", "x", "m"] for each in others))
    return Function(
        f"Jacobi{name}", f"jacobi_{name.lower()}", name.lower(), "", slope, f"Jacobi{name}", 2, special=True,
        value=lambda mp, u, m: mp.ellipfun(name.lower(), u, m=m),
    )  # fmt: skip


PERIODIC, CHANGING = {"behaviour": Behaviour.PERIODIC}, {"behaviour": Behaviour.CHANGING}
FUNCTIONS = (
    Function("Sqrt", "sqrt", "", "sqrt", _over(_times(2, "y"))),
    Function("Exp", "exp", "", "exp", "y", **CHANGING),
    Function("Ln", "log", r"\ln", "log", _over("x")),
    Function("Abs", "abs", "", "abs", ["Sign", "x"], "Abs", value=lambda mp, x: abs(x)),
    Function("Sign", "signum", "sign", "sign", 0, "sign", value=_real("sign")),
    Function("Sin", "sin", r"\sin", "sin", ["Cos", "x"], **PERIODIC),
    Function("Cos", "cos", r"\cos", "cos", ["Negate", ["Sin", "x"]], **PERIODIC),
    Function("Tan", "tan", r"\tan", "tan", _square(1, 1, "y"), **PERIODIC),
    Function("Sec", "sec", r"\sec", "", _times("y", ["Tan", "x"]), **PERIODIC),
    Function("Csc", "csc", r"\csc", "", _times(-1, "y", ["Cot", "x"]), **PERIODIC),
    Function("Cot", "cot", r"\cot", "", _square(-1, -1, "y"), **PERIODIC),
    Function("Sinh", "sinh", r"\sinh", "sinh", ["Cosh", "x"], **CHANGING),
    Function("Cosh", "cosh", r"\cosh", "cosh", ["Sinh", "x"], **CHANGING),
    Function("Tanh", "tanh", r"\tanh", "tanh", _square(1, -1, "y"), **CHANGING),
    Function("Sech", "sech", "sech", "", _times(-1, "y", ["Tanh", "x"]), **CHANGING),
    Function("Csch", "csch", "csch", "", _times(-1, "y", ["Coth", "x"]), **CHANGING),
    Function("Coth", "coth", r"\coth", "", _square(1, -1, "y"), **CHANGING),
    Function("Arcsin", "asin", r"\arcsin", "asin", _root(_square(1, -1))),
    Function("Arccos", "acos", r"\arccos", "acos", _root(_square(1, -1), -1)),
    Function("Arctan", "atan", r"\arctan", "atan", _over(_square(1, 1)), **CHANGING),
    Function("Arctan2", "atan2", r"\operatorname{arctan}_{2}", "atan2", arity=2, value=_real("atan2")),
    Function("Arcsec", "asec", "arcsec", "", _root(_times(_square(-1, 1), _times("x", "x")))),
    Function("Arccsc", "acsc", "arccsc", "", _root(_times(_square(-1, 1), _times("x", "x")), -1)),
    Function("Arccot", "acot", "arccot", "", _over(_square(1, 1), -1)),
    Function("Arsinh", "asinh", "arsinh", "asinh", _root(_square(1, 1))),
    Function("Arcosh", "acosh", "arcosh", "acosh", _root(_square(-1, 1))),
    Function("Artanh", "atanh", "artanh", "atanh", _over(_square(1, -1))),
    Function("Arsech", "asech", "arsech", "", _over(_times("x", ["Sqrt", _square(1, -1)]), -1)),
    Function("Arcsch", "acsch", "arcsch", "", _root(_times(_square(1, 1), _times("x", "x")), -1)),
    Function("Arcoth", "acoth", "arcoth", "", _over(_square(1, -1))),
    Function("Erf", "erf", "erf", "erf", _bell(2), **CHANGING),
    Function("Erfc", "erfc", "erfc", "", _bell(-2), special=True, **CHANGING),
    Function("Gamma", "gamma", r"\Gamma", "", _times("y", ["PolyGamma", 0, "x"]), special=True),
    Function(
        "PolyGamma", "psi", r"\psi", "", ["PolyGamma", ["Add", "n", 1], "x"], "polygamma", 2, of_an_order=True,
        special=True,
    ),
    Function("Zeta", "zeta", r"\zeta", special=True),
    *_airy("a"),
    *_airy("b"),
    *(_bessel("J", 1, -1), _bessel("Y", 1, -1), _bessel("I", 1, 1), _bessel("K", -1, -1)),
    *(_jacobi("Sn", 1, "Cn", "Dn"), _jacobi("Cn", -1, "Sn", "Dn"), _jacobi("Dn", _times(-1, "m"), "Sn", "Cn")),
)  # fmt: skip
