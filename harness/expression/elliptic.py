"""Jacobi's elliptic functions sn, cn, dn of (u, m) for SymPy, which lacks them.

The notation is Maxima's. Their derivatives by u are polynomials in themselves (DLMF 22.13.1-3). mpmath evaluates
them.
"""

from mpmath import mp
from sympy import Expr, Float, Function
from sympy.core.function import ArgumentIndexError


class _Jacobi(Function):
    """A Jacobi elliptic function, with the name `kind` in mpmath."""

    nargs = 2
    kind: str

    def fdiff(self, argindex: int = 1) -> Expr:
        """Return the derivative by u. The derivative by m is not supported."""
        if argindex != 1:
            raise ArgumentIndexError(self, argindex)
        return self._rate(*self.args)

    def _rate(self, u: Expr, m: Expr) -> Expr:
        raise NotImplementedError

    def _eval_evalf(self, prec: int) -> Expr | None:
        u, m = (argument._to_mpmath(prec) for argument in (each._evalf(prec) for each in self.args))
        with mp.workprec(prec):
            return Float._new(mp.ellipfun(self.kind, u, m=m)._mpf_, prec)


class JacobiSn(_Jacobi):
    """sn(u, m)."""

    kind = "sn"

    def _rate(self, u: Expr, m: Expr) -> Expr:
        return JacobiCn(u, m) * JacobiDn(u, m)


class JacobiCn(_Jacobi):
    """cn(u, m)."""

    kind = "cn"

    def _rate(self, u: Expr, m: Expr) -> Expr:
        return -JacobiSn(u, m) * JacobiDn(u, m)


class JacobiDn(_Jacobi):
    """dn(u, m)."""

    kind = "dn"

    def _rate(self, u: Expr, m: Expr) -> Expr:
        return -m * JacobiSn(u, m) * JacobiCn(u, m)
