"""Where a power series ends: its radius of convergence and nearest singularities, from its coefficients.

Near a singularity, or a complex pair of them, the coefficients follow in the end a three-term recurrence

    c_n + (p_0 + p_1/n + p_2/n^2 + ...) c_(n-1) + (s_0 + s_1/n + s_2/n^2 + ...) c_(n-2) = 0,

and the singularities z = t - t0 satisfy 1 + p_0 z + s_0 z^2 = 0. Without corrections, and from two such equations, this
is Mercer and Roberts' test. Here the corrections are fitted over the later orders, which extrapolates that test to
n = infinity, and Domb and Sykes' with it where one singularity stands alone; with two terms more, two pairs are told
apart. Each number of corrections gives an estimate; those that agree best with their neighbours are taken, and what
they differ by, times a factor of safety, is the uncertainty. Where they do not agree, the root test is left: |c_n|
falls like R^-n at a finite radius R, and faster by some power of n! where the motion is entire.

A series in even or in odd powers alone is one in the square of the time: its singularities come in pairs ±z.

References
----------
Mercer & Roberts, SIAM J. Appl. Math. 50 (1990) 1547; Domb & Sykes, Proc. R. Soc. A 240 (1957) 214;
Guttmann & Joyce, J. Phys. A 5 (1972) L81, for recurrences with corrections in 1/n.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import mpmath
import numpy as np
from numpy.typing import NDArray

from ..language import translatable

LAGS = (1, 2, 4)  # singularities that a recurrence knows
FEWEST = 12  # coefficients below which a series tells nothing about its end
MOST_CORRECTIONS = 5
LATER = (0.5, 0.7)  # shares of the orders after which a fit looks
EQUATIONS_PER_UNKNOWN = 1.2
# How wrong N orders can be, and the factor of safety, come from expansions to orders 8 to 160 whose end is known: those
# of tests/motion/test_radius.py and more of their kind.
ENTIRE_GROWTH, GROWTH_ERROR = 0.25, 24.0  # the power of n! is above 1/4 + 24/N: entire
FINITE_GROWTH = 4.0  # it is below 4/N: a finite radius
ROOT_TEST_ERROR = 12.0  # of log R, times N
NEGLIGIBLE = 1e-13  # relative to its neighbours: the rounding of a zero in double precision
SAFETY = 12.0  # times the difference of two estimates: the uncertainty
FARTHER = 1.2  # a singularity farther away by this factor still shows, as its power -N, in the last of N coefficients
FINEST = 1e-12  # relative uncertainty that a fit in double precision can have
COARSE = 0.1  # relative uncertainty that a fit may have


@dataclass(frozen=True)
class Radius:
    """Radius of convergence about the initial instant.

    Attributes
    ----------
    estimate : float or None
        None where there is none to state; the remark says why.
    singularities : tuple of complex
        The nearest ones, as t - t0.
    remark : str
        What was found, in words.
    """

    estimate: float | None
    uncertainty: float | None
    singularities: tuple[complex, ...]
    remark: str


POLYNOMIAL = Radius(None, None, (), translatable("infinite: the motion is a polynomial of the time"))
ENTIRE = Radius(None, None, (), translatable("infinite: the motion is entire, as far as its coefficients show"))
UNDECIDED = Radius(None, None, (), translatable("unknown: these orders do not tell how far the series holds"))
TOO_FEW = Radius(
    None, None, (), translatable("unknown: it takes %(count)s coefficients that are not zero", count=FEWEST)
)


def estimate_radius(series: Iterable[Sequence[mpmath.mpf]]) -> Radius:
    """Estimate the radius of convergence of a motion.

    Parameters
    ----------
    series : iterable of sequences of mpf
        Coefficients of power series in t - t0 that belong to one motion.

    Returns
    -------
    Radius
        The most certain estimate among those of the series that end first.
    """
    found = [_radius_of(coefficients) for coefficients in series]
    finite = [radius for radius in found if radius.estimate is not None]
    if finite:
        first_end = min(radius.estimate + radius.uncertainty for radius in finite)
        return min((r for r in finite if r.estimate - r.uncertainty <= first_end), key=lambda r: r.uncertainty)
    return next(kind for kind in (TOO_FEW, UNDECIDED, ENTIRE, POLYNOMIAL) if kind in found)


def truncation_error(coefficients: Sequence[mpmath.mpf], radius: Radius, time: float) -> float:
    """Estimate what the terms left out of a power series add up to.

    Parameters
    ----------
    time : float
        t - t0, inside the radius of convergence.

    Returns
    -------
    float
        The sum of a geometric series above the last terms; infinite where that does not converge.
    """
    last = len(coefficients) - 1
    terms = [float(abs(c) * mpmath.mpf(abs(time)) ** n) for n, c in enumerate(coefficients)]
    late = max(terms[-3:])
    if late == 0:
        return 0.0
    if radius.estimate is None:
        early = max(terms[last // 2 - 1 : last // 2 + 2])
        ratio = (late / early) ** (2 / last) if early else math.inf
    else:
        ratio = abs(time) / (radius.estimate - radius.uncertainty)
    return late * ratio / (1 - ratio) if ratio < 1 else math.inf


def _radius_of(coefficients: Sequence[mpmath.mpf]) -> Radius:
    if not any(coefficients[len(coefficients) // 2 :]):
        return POLYNOMIAL if len(coefficients) > FEWEST else TOO_FEW
    if len(coefficients) < FEWEST:
        return TOO_FEW
    scale, balanced = _balanced(coefficients)
    first, stride = _powers(balanced)
    strided = balanced[first::stride]
    if len(strided) < FEWEST:
        return TOO_FEW
    growth, last = _growth(strided), len(strided) - 1
    if growth > ENTIRE_GROWTH + GROWTH_ERROR / last:
        return ENTIRE
    by_roots, fitted = _root_test(strided, stride, scale), _fitted_radius(strided, stride, scale)
    if fitted is not None and fitted.uncertainty <= COARSE * fitted.estimate and _agree(fitted, by_roots):
        return fitted
    return by_roots if growth < FINITE_GROWTH / last and by_roots.uncertainty < by_roots.estimate else UNDECIDED


def _balanced(coefficients: Sequence[mpmath.mpf]) -> tuple[float, NDArray[np.float64]]:
    """Coefficients by the time in units of the scale, so chosen that the last are of the order of one."""
    last = len(coefficients) - 1
    scale = mpmath.power(max(abs(c) for c in coefficients[-4:]), mpmath.mpf(-1) / last)
    return float(scale), np.array([float(c * scale**n) for n, c in enumerate(coefficients)])


def _powers(balanced: NDArray[np.float64]) -> tuple[int, int]:
    """First power and distance of the powers that occur: (0, 1), or (0, 2) for even and (1, 2) for odd ones."""
    later = np.abs(balanced[2:])
    even, odd = later[::2].max(), later[1::2].max()
    if odd <= NEGLIGIBLE * even:
        return 0, 2
    if even <= NEGLIGIBLE * odd:
        return 1, 2
    return 0, 1


def _growth(balanced: NDArray[np.float64]) -> float:
    """Exponent a in |c_n|^(-1/n) ~ (n/e)^a: zero at a finite radius, 1/rho for an entire function of order rho."""
    n, logarithms = _envelope(balanced)
    factorials = np.array([math.lgamma(order + 1) for order in n])
    return -float(_slopes(logarithms, factorials, n)[0])


def _envelope(balanced: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Later orders, and log|c_n| there of the largest of three neighbours each."""
    n = np.arange((len(balanced) - 1) // 3 + 2, len(balanced))
    sizes = np.max([np.abs(balanced[n - shift]) for shift in range(3)], axis=0)
    return n[sizes > 0], np.log(sizes[sizes > 0])


def _slopes(values: NDArray[np.float64], *columns: NDArray) -> NDArray[np.float64]:
    """Coefficients of the columns, fitted to the values together with a constant."""
    solution, *_ = np.linalg.lstsq(np.column_stack([*columns, np.ones(len(values))]), values, rcond=None)
    return solution[:-1]


def _fitted_radius(balanced: NDArray[np.float64], stride: int, scale: float) -> Radius | None:
    """The estimate of the recurrence whose corrections agree best with fewer and with other orders."""
    choices = [choice for lags in LAGS for choice in _compared_fits(balanced, lags)]
    if not choices:
        return None
    difference, roots = min(choices, key=lambda choice: choice[0])
    nearest = float(abs(roots[0]))
    unseen = FARTHER ** (stride * (1 - len(balanced)))
    spread = (SAFETY * difference / nearest + unseen + FINEST) / stride
    singularities = [_in_time(root, stride, scale) for root in roots if abs(root) <= nearest * (1 + spread)]
    return _radius(nearest ** (1 / stride) * scale, spread, [z for group in singularities for z in group])


def _compared_fits(balanced: NDArray[np.float64], lags: int) -> list[tuple[float, NDArray[np.complex128]]]:
    """For each number of corrections: how far its estimates and those with one less lie apart, and its roots."""
    fits = []
    for corrections in range(MOST_CORRECTIONS + 1):
        roots = [_recurrence_roots(balanced, lags, corrections, later) for later in LATER]
        if any(len(found) == 0 for found in roots):
            break
        fits.append(roots)
    return [
        (float(np.ptp([abs(found[0]) for found in (*fewer, *these)])), these[-1]) for fewer, these in pairwise(fits)
    ]


def _radius(estimate: float, spread: float, singularities: Sequence[complex]) -> Radius:
    paired = any(abs(z.imag) > spread * abs(z) for z in singularities)
    pair, real = (
        translatable("the nearest singularity is a complex pair"),
        translatable("the nearest singularity is a real instant"),
    )
    return Radius(estimate, estimate * spread, tuple(singularities), pair if paired else real)


def _recurrence_roots(
    balanced: NDArray[np.float64], lags: int, corrections: int, later: float
) -> NDArray[np.complex128]:
    """Roots of the characteristic equation, the nearest first; empty where there are too few equations."""
    last = len(balanced) - 1
    n = np.arange(max(lags, int(last * later)), last + 1)
    if len(n) < EQUATIONS_PER_UNKNOWN * lags * (corrections + 1):
        return np.empty(0, dtype=complex)
    columns = [balanced[n - lag] * (last / n) ** j for j in range(corrections + 1) for lag in range(1, lags + 1)]
    solution, *_ = np.linalg.lstsq(np.column_stack(columns), -balanced[n], rcond=None)
    roots = np.roots([*solution[:lags][::-1], 1.0])
    return roots[np.argsort(np.abs(roots))]


def _in_time(root: complex, stride: int, scale: float) -> list[complex]:
    """The singularities in the time that a root in its stride-th power stands for."""
    if stride == 1:
        return [complex(root) * scale]
    z = complex(np.sqrt(complex(root))) * scale
    return [z, -z]


def _root_test(balanced: NDArray[np.float64], stride: int, scale: float) -> Radius:
    """log|c_n| = -n log R + b, and with a term a log n more: what that changes is uncertain."""
    n, logarithms = _envelope(balanced)
    slope, slope_with_power = (_slopes(logarithms, *columns)[0] for columns in ((n,), (n, np.log(n))))
    error = max(ROOT_TEST_ERROR / n[-1], SAFETY * abs(slope - slope_with_power)) / stride
    estimate = math.exp(-slope / stride) * scale
    remark = translatable("by the root test: the orders do not tell the nearest singularities apart")
    return Radius(estimate, estimate * math.expm1(error), (), remark)


def _agree(one: Radius, other: Radius) -> bool:
    return abs(one.estimate - other.estimate) <= one.uncertainty + other.uncertainty
