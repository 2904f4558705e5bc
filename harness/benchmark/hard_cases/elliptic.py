"""Angles that obey phi'' = -w^2 sin(phi), in elliptic functions (Whittaker, Analytical Dynamics, section 44)."""

from mpmath import ellipfun, ellipk, mpf, sin, sqrt

from .digits import certified


@certified
def swing(amplitude: mpf, frequency: mpf, t: mpf) -> tuple[mpf, mpf]:
    """sin(phi) and cos(phi) of a pendulum released at rest.

    Parameters
    ----------
    amplitude : mpf
        The greatest angle from below, less than pi.
    frequency : mpf
        Of small oscillations, w.
    """
    modulus = sin(amplitude / 2)
    half = modulus * ellipfun("sn", ellipk(modulus**2) + frequency * t, m=modulus**2)
    return 2 * half * sqrt(1 - half**2), 1 - 2 * half**2


@certified
def period(amplitude: mpf, frequency: mpf) -> mpf:
    """Period of a pendulum released at rest."""
    return 4 * ellipk(sin(amplitude / 2) ** 2) / frequency


@certified
def turning(frequency: mpf, t: mpf) -> tuple[mpf, mpf]:
    """sin(phi) and cos(phi) of the angle from above, which turns over from phi = 0 at the rate 1.

    Parameters
    ----------
    frequency : mpf
        w.
    """
    rate = sqrt(1 + 4 * frequency**2)
    m = (2 * frequency / rate) ** 2
    argument = rate * t / 2 - ellipk(m)
    sn, cn = ellipfun("sn", argument, m=m), ellipfun("cn", argument, m=m)
    return -2 * sn * cn, 2 * sn**2 - 1


@certified
def revolution(frequency: mpf) -> mpf:
    """Time of one revolution of the angle that turns over."""
    rate = sqrt(1 + 4 * frequency**2)
    return 4 * ellipk((2 * frequency / rate) ** 2) / rate
