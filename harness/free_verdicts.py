"""Consistency of the verdicts on free motion, with motions and with each other.

A law that is listed must make random motions free. A motion that is free for all states is tried likewise, under the
scene's law. The verdict that there is no law is tested by a random search for one. If a verdict fails, it becomes
undecided, and its reason reports the contradiction.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

from sympy import Expr, Symbol

from .crosscheck.law_search import find_free_law
from .crosscheck.report import CheckResult
from .crosscheck.seed import fresh_seed
from .crosscheck.system import MechanicalSystem
from .crosscheck.universal_laws import ControlLaw, verify_law
from .crosscheck.verdict import Verdict
from .language import translatable

T = TypeVar("T")
Law = Mapping[str, Expr]


@dataclass(frozen=True)
class FreeMotionTrial:
    """The data for trials of verdicts on free motion."""

    system: MechanicalSystem
    values: Mapping[Symbol, Expr]  # of the parameters
    span: tuple[Expr, Expr] | None  # first and last time

    def of_law(self, law: Law, positive: Sequence[Expr] = ()) -> CheckResult:
        """Verify a law by random motions on the time span.

        Parameters
        ----------
        law : mapping of str to SymPy expression
            Controls as functions of the time, by name.
        positive : sequence of SymPy expression
            The law holds only if these are positive.

        Returns
        -------
        CheckResult
        """
        return verify_law(self.system, self.values, ControlLaw(_symbols(law), tuple(positive)), self.span)

    def contradiction_of_free_motion(self, law: Law) -> str:
        """Return the first contradiction of a random motion to free motion for all states.

        Parameters
        ----------
        law : mapping of str to SymPy expression
            Law that the random motion follows.

        Returns
        -------
        str
            Empty if there is no contradiction.
        """
        found = self.of_law(law)
        if found.verdict is not Verdict.DISAGREES:
            return ""
        return translatable("under the scene's law %(detail)s", detail=found.detail)

    def verdict_on_laws(self, verdict: str, checks: Sequence[CheckResult]) -> tuple[str, str]:
        """Return the verdict on laws after their checks.

        Parameters
        ----------
        verdict : str
            Verdict of Maxima, as in `UniversalControls`.
        checks : sequence of CheckResult
            One for each law.

        Returns
        -------
        verdict : str
        reason : str
            Reason for a change, empty without a change.
        """
        found = [check.verdict for check in checks]
        if Verdict.DISAGREES in found:
            detail = next(check.detail for check in checks if check.verdict is Verdict.DISAGREES)
            return "undecided", translatable("the equations of motion contradict a law: %(detail)s", detail=detail)
        if Verdict.UNDECIDED in found:
            left = "some" if Verdict.AGREES in found else "undecided"
            return left, translatable("a law was not confirmed on the time span by the equations of motion")
        return ("undecided", reason) if verdict == "none" and (reason := self._law_found()) else (verdict, "")

    def _law_found(self) -> str:
        span = self.span and (float(self.span[0]), float(self.span[1]))
        found = find_free_law(self.system, self.values, span, fresh_seed())
        if found is None:
            return ""
        numbers = ", ".join(f"{name} = {value:.6g}" for name, value in {**found.controls, **found.parameters}.items())
        return translatable(
            "the search of closed forms found no law; a numerical search found one that leaves constraint forces of at "
            "most %(largest)s from t = %(first)s to t = %(last)s, in the middle with %(numbers)s",
            largest=f"{found.largest:.1g}",
            first=f"{found.time - found.reach:.6g}",
            last=f"{found.time + found.reach:.6g}",
            numbers=numbers,
        )


def _symbols(law: Mapping[str, T]) -> dict[Symbol, T]:
    return {Symbol(name, real=True): value for name, value in law.items()}
