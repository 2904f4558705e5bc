"""The functions of expressions, each with its names in every notation."""

from typing import NamedTuple


class Function(NamedTuple):
    """A function."""

    head: str  # of a tree in MathJSON
    scene: str  # in scene files, as Maxima calls it
    latex: str = ""  # a command, or a name that is set upright; empty where a formula has a sign of its own
    program: str = ""  # in C, Python, NumPy, JavaScript and heyoka; empty where these do not call it so
    sympy: str = ""  # where SymPy, or `holonom.elliptic`, calls it otherwise than Maxima; mpmath mostly does the same
    arity: int = 1
    of_an_order: bool = False  # in formulas the first argument stands below

    @property
    def in_sympy(self) -> str:
        """Name in SymPy or in `holonom.elliptic`."""
        return self.sympy or self.scene

    @property
    def operator(self) -> str:
        """Name in LaTeX."""
        return self.latex if self.latex.startswith("\\") else rf"\operatorname{{{self.latex}}}"


FUNCTIONS = (
    Function("Sqrt", "sqrt", program="sqrt"),
    Function("Exp", "exp", program="exp"),
    Function("Ln", "log", r"\ln", "log"),
    Function("Abs", "abs", sympy="Abs"),
    Function("Sign", "signum", "sign", sympy="sign"),
    Function("Sin", "sin", r"\sin", "sin"),
    Function("Cos", "cos", r"\cos", "cos"),
    Function("Tan", "tan", r"\tan", "tan"),
    Function("Sec", "sec", r"\sec"),
    Function("Csc", "csc", r"\csc"),
    Function("Cot", "cot", r"\cot"),
    Function("Sinh", "sinh", r"\sinh", "sinh"),
    Function("Cosh", "cosh", r"\cosh", "cosh"),
    Function("Tanh", "tanh", r"\tanh", "tanh"),
    Function("Sech", "sech", "sech"),
    Function("Csch", "csch", "csch"),
    Function("Coth", "coth", r"\coth"),
    Function("Arcsin", "asin", r"\arcsin", "asin"),
    Function("Arccos", "acos", r"\arccos", "acos"),
    Function("Arctan", "atan", r"\arctan", "atan"),
    Function("Arctan2", "atan2", "arctan2", "atan2", arity=2),
    Function("Arcsec", "asec", "arcsec"),
    Function("Arccsc", "acsc", "arccsc"),
    Function("Arccot", "acot", "arccot"),
    Function("Arsinh", "asinh", "arsinh", "asinh"),
    Function("Arcosh", "acosh", "arcosh", "acosh"),
    Function("Artanh", "atanh", "artanh", "atanh"),
    Function("Arsech", "asech", "arsech"),
    Function("Arcsch", "acsch", "arcsch"),
    Function("Arcoth", "acoth", "arcoth"),
    Function("Erf", "erf", "erf", "erf"),
    Function("Erfc", "erfc", "erfc"),
    Function("Gamma", "gamma", r"\Gamma"),
    Function("AiryAi", "airy_ai", "Ai", sympy="airyai"),
    Function("AiryBi", "airy_bi", "Bi", sympy="airybi"),
    Function("AiryAiPrime", "airy_dai", "Ai'", sympy="airyaiprime"),
    Function("AiryBiPrime", "airy_dbi", "Bi'", sympy="airybiprime"),
    Function("BesselJ", "bessel_j", "J", sympy="besselj", arity=2, of_an_order=True),
    Function("BesselY", "bessel_y", "Y", sympy="bessely", arity=2, of_an_order=True),
    Function("BesselI", "bessel_i", "I", sympy="besseli", arity=2, of_an_order=True),
    Function("BesselK", "bessel_k", "K", sympy="besselk", arity=2, of_an_order=True),
    Function("JacobiSn", "jacobi_sn", "sn", sympy="JacobiSn", arity=2),
    Function("JacobiCn", "jacobi_cn", "cn", sympy="JacobiCn", arity=2),
    Function("JacobiDn", "jacobi_dn", "dn", sympy="JacobiDn", arity=2),
)
