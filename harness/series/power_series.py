"""Power series of the initial motion, derived by Maxima, and their evaluation.

Coefficients are stored as text: exact numbers as p/q, rounded ones as decimal digits. Computations convert them to
mpmath's numbers with as many digits.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

import mpmath

from ..failures import ErrorKind, HolonomError
from ..formats import Publication, published
from ..language import translatable
from ..number_texts import number, numbers
from ..program.motion_program import Program
from ..schema import NumberText
from ..shown import Shown
from ..structs import entry, with_attributes
from .radius import LINEAR, POLYNOMIAL, UNPROVED, Radius, described, estimate_radius, truncation_error

WORKING_DIGITS = 50  # for what is computed from exact coefficients
MORE_DIGITS = 10  # than the coefficients have, for what is computed from rounded ones

ARITHMETIC = r"^(exact|double|extended|quadruple|(bigfloat|heyoka)\([1-9][0-9]*\))$"
NumberTexts = tuple[NumberText, ...]


@dataclass(frozen=True)
class Continuation:
    """States of a motion at the centres of its expansions, the last at the final time."""

    digits: int = entry("Number of digits.", minimum=1)
    times: NumberTexts = entry("Times of the expansions.")
    coordinates: Mapping[str, NumberTexts] = entry("Values of each coordinate at these times.")
    velocities: Mapping[str, NumberTexts] = entry("Values of each velocity at these times.")


@with_attributes
@dataclass(frozen=True, repr=False)
class MotionSeries(Shown):
    """The power series of one motion about its initial time."""

    scene: str = entry("Name that the scene is assigned to.")
    title: str = entry("Title of the scene.")
    order: int = entry("Highest power of t - t0.", minimum=2)
    t0: NumberText = entry("The initial time.")
    arithmetic: str = entry("exact, bigfloat(D), double, extended, quadruple or heyoka(D).", pattern=ARITHMETIC)
    coordinates: Mapping[str, NumberTexts] = entry("Coefficients of (t - t0)^0 ... (t - t0)^order, by name.")
    multipliers: Mapping[str, NumberTexts] = entry("Coefficients of the multipliers, by name.")
    constraint_forces: Mapping[str, NumberTexts] = entry("Lambda[s]; empty where the scene does not observe them.")
    controls: Mapping[str, NumberTexts] = entry(
        "Coefficients of the controls, by name; empty where the scene does not observe them."
    )
    continuation: Continuation | None = entry(
        "States at the times where the motion was expanded anew; null where no continuation is asked for.", None
    )
    switch: str | None = entry(
        "A function with whose sign the motion is another than the series; null where there is none. "
        "If it is zero at t0, the series is the motion after t0.",
        None,
    )
    switching_time: NumberText | None = entry(
        "The first time after t0 at which it changes; null where that is not of the time alone.", None
    )
    polynomial: bool = entry(
        "Whether the equations of motion are satisfied identically by the series as they end here.", False
    )
    sensitivities: Mapping[str, NumberTexts] = entry(
        "Derivatives of the coefficients by parameters and initial values, by names such as d(x, m).", dict
    )
    program: Program | None = entry(
        "Program of t, coordinates and velocities: accelerations and what the series are of; null where there is none.",
        None,
    )

    @property
    def digits(self) -> int:
        """Decimal digits to compute with."""
        inside = self.arithmetic.partition("(")[2].rstrip(")")
        return int(inside) + MORE_DIGITS if inside else WORKING_DIGITS

    @cached_property
    def radius(self) -> Radius:
        """Radius of convergence about t0."""
        from .entire import is_entire
        from .singularities import decided

        if self.polynomial and not self.sensitivities:
            return replace(POLYNOMIAL, coefficients=self.order + 1)
        if self.program is not None and is_entire(self.program, self.program.inputs[1:]):
            return replace(LINEAR, coefficients=self.order + 1)
        with mpmath.workdps(self.digits):
            found = estimate_radius([numbers(series) for _, series in self.all_series()])
            found = replace(found, note=UNPROVED.note) if found == POLYNOMIAL else found
            return decided(found, [numbers(row) for row in self.coordinates.values()], self.program, number(self.t0))

    def all_series(self) -> Iterator[tuple[str, NumberTexts]]:
        """Yield name and coefficients of each series.

        Yields
        ------
        name : str
            Coordinate, multiplier or constraint force, then their derivatives.
        coefficients : tuple of str, shape (order + 1,)
            Those of (t - t0)^0, (t - t0)^1, and so on.
        """
        for group in self.groups():
            yield from group.items()

    def groups(self) -> tuple[Mapping[str, NumberTexts], ...]:
        """Return the series by kinds of quantities, derivatives last.

        Returns
        -------
        tuple of mapping of str to tuple of str
        """
        return self.coordinates, self.multipliers, self.constraint_forces, self.controls, self.sensitivities


@dataclass(frozen=True)
class Values:
    """Sums of the series at a given time, with their truncation errors."""

    time: Fraction
    values: Mapping[str, mpmath.mpf]
    truncation_error: float


@dataclass(frozen=True)
class SeriesValues:
    """Sums of the series at a given time."""

    t: str = entry("Time of the values.")
    values: Mapping[str, str] = entry("Value of each quantity, by its name.")
    truncation_error: float = entry("Estimated truncation error.")


Published = float | NumberText
PublishedSeries = Mapping[str, tuple[Published, ...]]


@dataclass(frozen=True)
class SeriesDocument:
    """The power series of a motion about its initial time.

    Numbers beyond double precision are decimal text, exact ones p/q.
    """

    scene: str = entry("Name that the scene is assigned to.")
    title: str = entry("Title of the scene.")
    switch: str | None = entry(
        "A function with whose sign the motion is another than the series; null where there is none. "
        "If it is zero at t0, the series is the motion after t0."
    )
    order: int = entry("Highest power of t - t0.", minimum=2)
    t0: Published = entry("The initial time.")
    arithmetic: str = entry("exact, bigfloat(D), double, extended, quadruple or heyoka(D).", pattern=ARITHMETIC)
    coordinates: PublishedSeries = entry("Coefficients of (t - t0)^0 ... (t - t0)^order, by name.")
    multipliers: PublishedSeries = entry("Coefficients of the multipliers, by name.")
    constraint_forces: PublishedSeries = entry("Lambda[s]; empty where the scene does not observe them.")
    controls: PublishedSeries = entry(
        "Coefficients of the controls, by name; empty where the scene does not observe them."
    )
    sensitivities: PublishedSeries = entry(
        "Derivatives of these coefficients by parameters and initial values, by names such as d(x, m)."
    )
    radius_of_convergence: Radius = entry(
        "Radius of convergence about t0, how uncertain it is, and the singularities that set it."
    )
    at: SeriesValues | None = entry("Sums of the series at a given time, where that is asked for.", None, optional=True)
    continuation: Continuation | None = entry(
        "States at the times where the motion was expanded anew, where that is asked for.", None, optional=True
    )


def values_at(motion: MotionSeries, time: Fraction) -> Values:
    """Add the series up at a given time inside the radius of convergence.

    Parameters
    ----------
    motion : MotionSeries
        The series to add up.
    time : Fraction
        The time t, in the scene's unit.

    Returns
    -------
    Values
        Sums by name, and the largest truncation error.

    Raises
    ------
    HolonomError
        The time is not inside the radius of convergence, or that is unknown and the terms do not fall, or a sign in
        the system or the law may have changed before.
    """
    with mpmath.workdps(motion.digits):
        step = mpmath.mpf(time.numerator) / time.denominator - number(motion.t0)
        if motion.switch is not None and step and not _is_before_switching(motion, step):
            raise HolonomError(ErrorKind.SERIES_SWITCHED, motion.scene, motion.switch)
        _require_inside(motion, time, float(abs(step)))
        series = {name: numbers(texts) for name, texts in motion.all_series()}
        left_out = max(truncation_error(c, motion.radius, float(step)) for c in series.values())
        if math.isinf(left_out):
            raise HolonomError(
                ErrorKind.BEYOND_RADIUS,
                detail=translatable(
                    "the terms of the series about t = %(start)s do not fall at t = %(time)s; "
                    "its radius of convergence is %(note)s",
                    start=motion.t0,
                    time=f"{float(time):g}",
                    note=motion.radius.note,
                ),
            )
        sums = {name: mpmath.polyval(coefficients[::-1], step) for name, coefficients in series.items()}
        return Values(time, sums, left_out)


def _is_before_switching(motion: MotionSeries, step: mpmath.mpf) -> bool:
    until = motion.switching_time
    return until is not None and 0 < step <= number(until) - number(motion.t0)


def series_document(motion: MotionSeries, values: Values | None = None) -> dict[str, Any]:
    """Return the content of `holonom series --json`.

    Parameters
    ----------
    motion : MotionSeries
        The series. Numbers are published as text unless they are doubles.
    values : Values or None
        Sums at one time, published as ``at``.

    Returns
    -------
    dict
        Content with format and version.
    """
    t0 = float(number(motion.t0))
    singularities = tuple(t0 + z for z in motion.radius.singularities)
    content = SeriesDocument(
        motion.scene,
        motion.title,
        motion.switch,
        motion.order,
        _published(motion, motion.t0),
        motion.arithmetic,
        *(_published_series(motion, group) for group in motion.groups()),
        replace(motion.radius, singularities=singularities),
        values and SeriesValues(str(values.time), _texts(values, motion.digits), values.truncation_error),
        motion.continuation,
    )
    return published(Publication.SERIES, content)


def _texts(values: Values, digits: int) -> dict[str, str]:
    return {name: mpmath.nstr(value, digits) for name, value in values.values.items()}


def _require_inside(motion: MotionSeries, time: Fraction, distance: float) -> None:
    radius = motion.radius
    if radius.estimate is None or distance < radius.estimate - radius.uncertainty:
        return
    if distance < radius.estimate:
        raise HolonomError(
            ErrorKind.BEYOND_RADIUS,
            detail=translatable(
                "whether the series about t = %(start)s converges at t = %(time)s is not known: "
                "its radius of convergence is %(radius)s, %(evidence)s; a higher order determines it more closely",
                start=motion.t0,
                time=f"{float(time):g}",
                radius=radius.shown,
                evidence=described(radius),
            ),
        )
    nearest = ", ".join(f"{float(number(motion.t0)) + z.real:.6g}{z.imag:+.6g}i" for z in radius.singularities)
    at_nearest = translatable("its nearest singularities are at %(nearest)s", nearest=nearest)
    reason = at_nearest if nearest else radius.note
    raise HolonomError(
        ErrorKind.BEYOND_RADIUS,
        detail=translatable(
            "the series about t = %(start)s does not converge at t = %(time)s: "
            "its radius of convergence is %(radius)s, %(evidence)s; %(reason)s",
            start=motion.t0,
            time=f"{float(time):g}",
            radius=radius.shown,
            evidence=described(radius),
            reason=reason,
        ),
    )


def _published(motion: MotionSeries, text: str) -> str | float:
    return float(text) if motion.arithmetic == "double" else text


def _published_series(motion: MotionSeries, group: Mapping[str, NumberTexts]) -> dict[str, list[str | float]]:
    return {name: [_published(motion, text) for text in coefficients] for name, coefficients in group.items()}
