"""Estimate the radius of convergence and nearest singularities from coefficients.

Near a singularity, or a complex pair of them, the coefficients approach a three-term recurrence

    c_n + (p_0 + p_1/n + p_2/n^2 + ...) c_(n-1) + (s_0 + s_1/n + s_2/n^2 + ...) c_(n-2) = 0,

and the singularities z = t - t0 satisfy 1 + p_0 z + s_0 z^2 = 0. Without corrections, and from two such equations,
this is Mercer and Roberts' test. Here the corrections are fitted over the later orders, which extrapolates that test
to n = infinity, and Domb and Sykes' with it if there is a single singularity. Further terms distinguish several.
Each number of corrections gives an estimate. Those that agree best with their neighbours are taken, and their
difference, times a factor of safety, is the uncertainty, but at least the distance of a nearer, weaker singularity
that such a difference hides. If they do not agree, the root test is used: |c_n| falls like R^-n at a finite radius R,
and faster by some power of n! if the motion is entire. What contradicts it is open.

A series in even or in odd powers alone is one in the square of the time: its singularities come in pairs ±z.

References
----------
Mercer & Roberts, SIAM J. Appl. Math. 50 (1990) 1547. Domb & Sykes, Proc. R. Soc. A 240 (1957) 214.
Guttmann & Joyce, J. Phys. A 5 (1972) L81, for recurrences with corrections in 1/n.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from typing import TYPE_CHECKING, NamedTuple

import mpmath

from ..language import Message, translatable
from ..schema import PAIRS
from ..structs import entry

LAGS = (1, 2, 3, 4)  # singularities that a recurrence knows
FEWEST = 12  # fewest coefficients from which a radius is estimated
MOST_CORRECTIONS = 5
LAST = 4  # coefficients of which the largest is brought to the order of one
LATER = (0.5, 0.7)  # shares of the orders after which a fit looks
EQUATIONS_PER_UNKNOWN = 1.2
# How wrong N orders can be, and the factor of safety, come from expansions to orders 8 to 160 whose end is known: those
# of tests/series/test_radius.py and more of their kind.
ENTIRE_GROWTH, GROWTH_ERROR = 0.25, 24.0  # the power of n! is above 1/4 + 24/N: entire
FINITE_GROWTH = 4.0  # it is below 4/N: a finite radius
ROOT_TEST_ERROR = 12.0  # of log R, times N
NEGLIGIBLE = 1e-13  # relative to its neighbours: the rounding of a zero in double precision
SAFETY = 12.0  # times the difference of two estimates: the uncertainty
FARTHER = 1.2  # a singularity farther away by this factor still shows, as its power -N, in the last of N coefficients
WEAKER = 2.5  # the power of the orders by which a nearer singularity may be weaker, as sqrt(1 - t)^3 is than 1/(2 - t)
FINEST = 1e-12  # relative uncertainty that a fit in double precision can have
COARSE = 0.2  # relative uncertainty that a fit may have
SMALLEST = 1e-290  # with its reciprocal: sizes between which double precision has all its digits
DEPENDENT = 1e-13  # of the largest pivot: columns that differ by rounding only

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Radius:
    """Radius of convergence about the initial time."""

    estimate: float | None = entry("Estimate of the radius; null if there is none, for the reason in the note.")
    uncertainty: float | None = entry("Uncertainty of the estimate; null if there is none.")
    singularities: tuple[complex, ...] = entry("Real and imaginary parts of the nearest ones.", **PAIRS)
    note: str = entry("Note on the estimate.")
    located: bool = entry(
        "True if the equations of motion are singular there; false if only the coefficients show the singularity.",
        False,
    )
    coefficients: int = entry("Number of coefficients that were looked at.", 0, compare=False)
    unseen: float | None = entry(
        "Largest strength, relative to the one found, of a singularity at nine tenths of its distance that would "
        "remain undetected; null without an estimate from coefficients.",
        None,
        compare=False,
    )

    @property
    def shown(self) -> str:
        """Estimate, in the digits that its uncertainty leaves."""
        digits = math.log10(self.estimate / self.uncertainty) if self.uncertainty else MOST_DIGITS
        return f"{self.estimate:.{min(max(math.floor(digits), 1), MOST_DIGITS)}g}"


MOST_DIGITS = 8  # of an estimate that is shown
NEARER = 0.9  # of the estimate: where a weak singularity may hide

POLYNOMIAL = Radius(None, None, (), translatable("infinite: the motion is a polynomial of the time"))
LINEAR = Radius(
    None, None, (), translatable("infinite: the equations of motion are linear, and their coefficients are entire")
)
UNPROVED = Radius(None, None, (), translatable("unknown: no higher powers occur, and that none follow is not proved"))
ENTIRE = Radius(
    None,
    None,
    (),
    translatable("infinite as far as these orders show: the coefficients are those of an entire motion"),
)
UNDECIDED = Radius(None, None, (), translatable("unknown: these orders do not determine it"))
COMPLEX_PAIR = translatable("the nearest singularity is a complex pair")
REAL_TIME = translatable("the nearest singularity is a real time")
TOO_FEW = Radius(
    None, None, (), translatable("unknown: at least %(count)s nonzero coefficients are needed", count=FEWEST)
)


def estimate_radius(series: Iterable[Sequence[mpmath.mpf]]) -> Radius:
    """Estimate the radius of convergence of a motion from its power series in t - t0.

    The result is the most certain of the estimates of the series with the smallest radii. It is undecided if the
    radius of a series is, and the root test of this one gives a smaller one.

    Parameters
    ----------
    series : iterable of sequence of mpf, shape (orders,)
        Coefficients of each coordinate, the constant first.

    Returns
    -------
    Radius
    """
    rows = list(series)
    return _of_so_many(_first_end([_radius_of(coefficients) for coefficients in rows]), len(rows[0]) if rows else 0)


def described(radius: Radius) -> Message:
    """Return the evidence for a radius, in words.

    Parameters
    ----------
    radius : Radius
        A finite radius.

    Returns
    -------
    Message
    """
    if radius.located:
        return translatable("where the equations of motion are singular")
    return translatable(
        "estimated from %(coefficients)s coefficients, uncertain by %(uncertainty)s; "
        "a singularity at %(nearer)s of it that is weaker than %(unseen)s of the one found is not seen",
        coefficients=radius.coefficients,
        uncertainty=f"{radius.uncertainty:.1g}",
        nearer=NEARER,
        unseen=f"{radius.unseen:.1g}",
    )


def _of_so_many(radius: Radius, coefficients: int) -> Radius:
    """Return an estimate with the uncertainty left by the number of coefficients."""
    if radius.estimate is None:
        return replace(radius, coefficients=coefficients)
    unseen = radius.uncertainty / radius.estimate * NEARER**coefficients
    return replace(radius, coefficients=coefficients, unseen=unseen)


def estimate_radii(series: Floats) -> list[Radius]:
    """Estimate the radii of convergence of many motions at a time.

    The method is that of `estimate_radius`. The result for a motion does not depend on the others.

    Parameters
    ----------
    series : ndarray, shape (series, orders, motions)
        Finite coefficients.

    Returns
    -------
    list of Radius
        One for each motion.
    """
    import numpy as np

    each, orders, motions = series.shape
    flat = np.ascontiguousarray(np.moveaxis(series, 2, 0).reshape(motions * each, orders))
    with np.errstate(all="ignore"):
        found = _radii_of_floats(flat)
    return [_of_so_many(_first_end(found[first : first + each]), orders) for first in range(0, motions * each, each)]


class _Row(NamedTuple):
    """The radius of one series, and that of the root test alone if it applies."""

    radius: Radius
    by_roots: float = math.inf


def _first_end(rows: Sequence[_Row]) -> Radius:
    found = [row.radius for row in rows]
    finite = [radius for radius in found if radius.estimate is not None]
    if finite:
        first_end = min(radius.estimate + radius.uncertainty for radius in finite)
        best = min((r for r in finite if r.estimate - r.uncertainty <= first_end), key=lambda r: r.uncertainty)
        nearest = min((row.by_roots for row in rows if row.radius == UNDECIDED), default=math.inf)
        return best if nearest >= best.estimate - best.uncertainty else UNDECIDED
    return next(kind for kind in (TOO_FEW, UNDECIDED, ENTIRE, POLYNOMIAL) if kind in found)


def truncation_error(coefficients: Sequence[mpmath.mpf], radius: Radius, time: float) -> float:
    """Estimate the truncation error of a power series.

    The estimate is the sum of a geometric series above the last terms, infinite if that diverges.

    Parameters
    ----------
    coefficients : sequence of mpf, shape (order + 1,)
        The constant first.
    radius : Radius
        Radius of convergence of the series.
    time : float
        t - t0, in the scene's unit.

    Returns
    -------
    float
        In the unit of the sum.
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


def _radius_of(coefficients: Sequence[mpmath.mpf]) -> _Row:
    import numpy as np

    with np.errstate(all="ignore"):
        floats = np.array([float(c) for c in coefficients])
        if all(c == 0 or SMALLEST < abs(x) < 1 / SMALLEST for c, x in zip(coefficients, floats, strict=True)):
            return _radii_of_floats(floats[None])[0]
        if not any(coefficients[len(coefficients) // 2 :]):
            return _Row(POLYNOMIAL if len(coefficients) > FEWEST else TOO_FEW)
        if len(coefficients) < FEWEST:
            return _Row(TOO_FEW)
        if not any(coefficients[-LAST:]):
            return _Row(UNDECIDED)
        scale = mpmath.power(max(abs(c) for c in coefficients[-LAST:]), mpmath.mpf(-1) / (len(coefficients) - 1))
        balanced = np.array([float(c * scale**n) for n, c in enumerate(coefficients)])
        return _radii_of_balanced(np.array([float(scale)]), balanced[None])[0]


def _radii_of_floats(series: Floats) -> list[_Row]:
    """Return the radii of series in double precision, shape (m, orders)."""
    import numpy as np

    orders = series.shape[1]
    if orders < FEWEST:
        return [_Row(TOO_FEW)] * len(series)
    late = series[:, orders // 2 :].any(axis=1)
    found = [_Row(UNDECIDED if each else POLYNOMIAL if orders > FEWEST else TOO_FEW) for each in late]
    going = np.flatnonzero(series[:, -LAST:].any(axis=1))
    scale = np.max(np.abs(series[going, -LAST:]), axis=1) ** (-1.0 / (orders - 1))
    mantissa, exponent = np.frexp(scale)  # so that no power leaves the range of the numbers
    n = np.arange(orders)
    balanced = np.ldexp(series[going] * mantissa[:, None] ** n, exponent[:, None] * n)
    for place, row in zip(going, _radii_of_balanced(scale, balanced), strict=True):
        found[place] = row
    return found


def _radii_of_balanced(scale: Floats, balanced: Floats) -> list[_Row]:
    """Return the radii of series with balanced coefficients.

    The unit of time is a scale, shape (m,), that makes their last coefficients of order one.

    Parameters
    ----------
    balanced : ndarray, shape (m, orders)
    """
    import numpy as np

    found = np.empty(len(balanced), dtype=object)
    first, stride = _powers(balanced)
    for powers in sorted(set(zip(first.tolist(), stride.tolist(), strict=True))):
        here = np.flatnonzero((first == powers[0]) & (stride == powers[1]))
        rows = _radii_of_strided(scale[here], np.ascontiguousarray(balanced[here, powers[0] :: powers[1]]), powers[1])
        for place, row in zip(here, rows, strict=True):
            found[place] = row
    return list(found)


def _radii_of_strided(scale: Floats, balanced: Floats, stride: int) -> list[_Row]:
    """Return the radii of series without missing powers, shape (m, orders).

    The variable is the stride-th power of the time.
    """
    last = balanced.shape[1] - 1
    if last + 1 < FEWEST:
        return [_Row(TOO_FEW)] * len(balanced)
    envelope = _envelope(balanced)
    growth = _growth(*envelope)
    by_roots, fitted = _root_tests(*envelope, stride, scale), _fitted_radii(balanced, stride, scale)
    found = []
    for g, roots, fit in zip(growth, by_roots, fitted, strict=True):
        if g > ENTIRE_GROWTH + GROWTH_ERROR / last:
            found.append(ENTIRE)
        elif fit is not None and fit.uncertainty <= COARSE * fit.estimate:
            found.append(fit if _agree(fit, roots) else UNDECIDED)
        else:
            found.append(roots if g < FINITE_GROWTH / last and roots.uncertainty < roots.estimate else UNDECIDED)
    return [_Row(radius, roots.estimate) for radius, roots in zip(found, by_roots, strict=True)]


def _powers(balanced: Floats) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return first power and distance of the powers that occur.

    These are (0, 1), or (0, 2) for even and (1, 2) for odd powers.
    """
    import numpy as np

    later = np.abs(balanced[:, 2:])
    even, odd = later[:, ::2].max(axis=1), later[:, 1::2].max(axis=1)
    only_even, only_odd = odd <= NEGLIGIBLE * even, even <= NEGLIGIBLE * odd
    return np.where(only_odd & ~only_even, 1, 0), np.where(only_even | only_odd, 2, 1)


def _envelope(balanced: Floats) -> tuple[NDArray[np.int64], Floats]:
    """Return later orders, shape (k,), and the envelope of log|c_n|, shape (m, k).

    The envelope is the largest of three neighbours.
    """
    import numpy as np

    n = np.arange((balanced.shape[1] - 1) // 3 + 2, balanced.shape[1])
    return n, np.log(np.max([np.abs(balanced[:, n - shift]) for shift in range(3)], axis=0))


def _growth(n: NDArray[np.int64], logarithms: Floats) -> Floats:
    """Return the exponent a in |c_n|^(-1/n) ~ (n/e)^a.

    It is zero for a finite radius, and 1/rho for an entire function of order rho.
    """
    return -_slopes(n, logarithms, lambda n: [[math.lgamma(order + 1) for order in n], n])


def _slopes(
    n: NDArray[np.int64], logarithms: Floats, columns: Callable[[NDArray[np.int64]], list[ArrayLike]]
) -> Floats:
    """Return the coefficients of the first column in a fit to logarithms.

    The other columns and a constant are fitted together with it.
    """
    import numpy as np

    slopes = np.empty(len(logarithms))
    there = np.isfinite(logarithms)  # where not, three coefficients in a row are zero
    for chosen in np.unique(there, axis=0):
        here = (there == chosen).all(axis=1)
        weights = np.linalg.pinv(np.column_stack([*columns(n[chosen]), np.ones(chosen.sum())]))[0]
        slopes[here] = reduce(np.add, weights[:, None] * logarithms[np.ix_(here, chosen)].T, 0.0)
    return slopes


def _root_tests(n: NDArray[np.int64], logarithms: Floats, stride: int, scale: Floats) -> list[Radius]:
    """Return radii by the fit log|c_n| = -n log R + b, and their uncertainties.

    The uncertainty is the change of the result if a term a log n is added.
    """
    import numpy as np

    slope = _slopes(n, logarithms, lambda n: [n])
    with_power = _slopes(n, logarithms, lambda n: [n, np.log(n)])
    error = np.maximum(ROOT_TEST_ERROR / n[-1], SAFETY * np.abs(slope - with_power)) / stride
    estimate = np.exp(-slope / stride) * scale
    note = translatable("by the root test: the orders do not separate the nearest singularities")
    return [
        Radius(r, u, (), note) for r, u in zip(estimate.tolist(), (estimate * np.expm1(error)).tolist(), strict=True)
    ]


def _fitted_radii(balanced: Floats, stride: int, scale: Floats) -> list[Radius | None]:
    """Return the estimates of the recurrences that agree best.

    They are compared with those of fewer and more corrections, and of other orders.
    """
    import numpy as np

    choices = [choice for lags in LAGS for choice in _compared_fits(balanced, lags)]
    if not choices:
        return [None] * len(balanced)
    differences = np.array([difference for difference, _ in choices])
    best = np.argmin(np.where(np.isnan(differences), np.inf, differences), axis=0)
    unseen = FARTHER ** (stride * (1 - balanced.shape[1]))
    found, last = [], balanced.shape[1] - 1
    for row, choice in enumerate(best.tolist()):
        roots, difference = choices[choice][1][row], float(differences[choice, row])
        nearest = float(abs(roots[0]))
        spread = SAFETY * difference / nearest + FINEST
        spread = max(spread + unseen, (WEAKER * math.log(last) + math.log(spread)) / last) / stride
        singularities = [_in_time(root, stride, scale[row]) for root in roots if abs(root) <= nearest * (1 + spread)]
        found.append(
            _radius(nearest ** (1 / stride) * float(scale[row]), spread, [z for group in singularities for z in group])
        )
    return found


def _compared_fits(balanced: Floats, lags: int) -> list[tuple[Floats, NDArray[np.complex128]]]:
    """Return distances of estimates, and roots, for each number of corrections.

    The distance is that from the estimates with one correction less, and with one more: two neighbours alone agree
    by chance on a farther, stronger singularity.

    Returns
    -------
    list of (ndarray, shape (m,), ndarray, shape (m, lags))
    """
    import numpy as np

    last = balanced.shape[1] - 1
    orders = [np.arange(max(lags, int(last * later)), last + 1) for later in LATER]
    most = min(MOST_CORRECTIONS, int(min(map(len, orders)) / (EQUATIONS_PER_UNKNOWN * lags)) - 1)
    if most < 0:
        return []
    fits = [_recurrence_roots(balanced, lags, n, most) for n in orders]
    nearest = [[np.abs(roots[:, 0]) for roots in each] for each in zip(*fits, strict=True)]
    return [
        (np.ptp(np.concatenate(nearest[corrections - 1 : corrections + 2]), axis=0), fits[-1][corrections])
        for corrections in range(1, len(nearest))
    ]


def _radius(estimate: float, spread: float, singularities: Sequence[complex]) -> Radius:
    kind = COMPLEX_PAIR if any(abs(z.imag) > spread * abs(z) for z in singularities) else REAL_TIME
    return Radius(estimate, estimate * spread, tuple(singularities), kind)


def _recurrence_roots(balanced: Floats, lags: int, n: NDArray[np.int64], most: int) -> list[NDArray[np.complex128]]:
    """Return the roots of the characteristic equations, the nearest first.

    They have the shape (m, lags) for each number of corrections.

    The columns of fewer corrections are the first of those of more: one factorisation serves them all.
    """
    import numpy as np

    columns = [balanced[:, n - lag] * (n[-1] / n) ** j for j in range(most + 1) for lag in range(1, lags + 1)]
    matrices, right = np.stack(columns, axis=2), -balanced[:, n]
    q, r = np.linalg.qr(matrices)
    diagonal = np.abs(np.diagonal(r, axis1=1, axis2=2))
    regular = np.minimum.accumulate(diagonal, axis=1) > DEPENDENT * np.maximum.accumulate(diagonal, axis=1)
    whole = regular.all(axis=1)
    inverse = np.linalg.inv(np.where(whole[:, None, None], r, np.eye(r.shape[1])))
    projected = np.matmul(right[:, None], q)[:, 0]
    found = []
    for size in range(lags, len(columns) + 1, lags):
        solution = np.matmul(inverse[:, :lags, :size], projected[:, :size, None])[:, :, 0]
        for row in np.flatnonzero(~whole):
            solution[row] = np.linalg.lstsq(matrices[row, :, :size], right[row], rcond=None)[0][:lags]
        found.append(_roots(solution))
    return found


def _roots(recurrences: Floats) -> NDArray[np.complex128]:
    """Return the zeros of 1 + p_1 z + p_2 z^2 + ..., the nearest first.

    They are reciprocals of eigenvalues, shape (m, lags).
    """
    import numpy as np

    lags = recurrences.shape[1]
    companions = np.zeros((len(recurrences), lags, lags))
    companions[:, 0] = -np.where(np.isfinite(recurrences), recurrences, 0.0)
    companions[:, range(1, lags), range(lags - 1)] = 1.0
    roots = 1.0 / np.linalg.eigvals(companions).astype(complex)
    roots[~np.isfinite(recurrences).all(axis=1)] = np.nan
    return np.take_along_axis(roots, np.argsort(np.abs(roots), axis=1, kind="stable"), axis=1)


def _in_time(root: complex, stride: int, scale: float) -> list[complex]:
    """Return the singularities in the time that belong to a root in its power.

    The power is the stride-th.
    """
    import numpy as np

    if stride == 1:
        return [complex(root) * scale]
    z = complex(np.sqrt(complex(root))) * scale
    return [z, -z]


def _agree(one: Radius, other: Radius) -> bool:
    return abs(one.estimate - other.estimate) <= one.uncertainty + other.uncertainty
