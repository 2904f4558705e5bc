"""The paper's example under u = u0 + t, expanded by a recurrence written by hand."""

from fractions import Fraction
from typing import TypeVar

Number = TypeVar("Number")


def paper_by_hand(order: int, u0: Number, q1: tuple[Number, Number], q2: tuple[Number, Number]) -> dict[str, list]:
    """Equation (14) under u = u0 + t, from (q1, dot q1) and (q2, dot q2). With s = q1 + q2:

    ddot(q1) = -s - u lambda, ddot(q2) = -2 dot(s) - u lambda, ddot(q3) = lambda with q3 = u s, hence
    (1 + 2 u^2) lambda = 2 dot(s) - u (s + 2 dot(s)).
    """
    q1, q2, reaction = list(q1), list(q2), []

    def at(row: list, n: int) -> Number:
        return row[n] if n >= 0 else 0

    for n in range(order + 1):
        s = [a + b for a, b in zip(q1[-2:], q2[-2:], strict=True)]
        rate, rate_before = (n + 1) * s[1], n * s[0]
        driven = 2 * rate - u0 * (s[0] + 2 * rate) - at(q1, n - 1) - at(q2, n - 1) - 2 * rate_before
        reaction.append((driven - 4 * u0 * at(reaction, n - 1) - 2 * at(reaction, n - 2)) / (1 + 2 * u0**2))
        carried = u0 * reaction[n] + at(reaction, n - 1)
        q1.append((-s[0] - carried) / ((n + 1) * (n + 2)))
        q2.append((-2 * rate - carried) / ((n + 1) * (n + 2)))
    s = [a + b for a, b in zip(q1, q2, strict=True)]
    q3 = [u0 * s[n] + at(s, n - 1) for n in range(order + 1)]
    return {"q1": q1[: order + 1], "q2": q2[: order + 1], "q3": q3, "lambda1": reaction}


START = {"q1": (Fraction(1), Fraction(1, 2)), "q2": (Fraction(2), Fraction(-1, 3))}
