"""The paper's example under the control (15), u = u0 exp(t), in closed form: its motion is free.

The sum s = q1 + q2 obeys s'' + 2 s' + s = 0, so that s = (a + b t) exp(-t); q1'' = -s and q3 = u s.
"""

from mpmath import exp, mpf

from .digits import certified

FILE, SCENE = "paper/paper.mac", "free_motion_scene"
with certified:
    U0, Q1, Q2, V1, V2 = mpf(3) / 10, mpf(1), mpf(2), mpf(1) / 2, -mpf(1) / 3  # as in the scene
A, B = Q1 + Q2, Q1 + Q2 + V1 + V2


@certified
def coordinates(t: mpf) -> list[mpf]:
    """Coordinates q1, q2, q3 at an instant."""
    q1 = Q1 + (V1 - A - B) * t + A + 2 * B - (A + 2 * B + B * t) * exp(-t)
    return [q1, (A + B * t) * exp(-t) - q1, U0 * (A + B * t)]


@certified
def velocities(t: mpf) -> list[mpf]:
    """Velocities of q1, q2, q3 at an instant."""
    v1 = V1 - A - B + (A + B + B * t) * exp(-t)
    return [v1, (B - A - B * t) * exp(-t) - v1, U0 * B]


@certified
def forces(t: mpf) -> list[mpf]:
    """Spring and damping at an instant."""
    return [-(A + B * t) * exp(-t), -2 * (B - A - B * t) * exp(-t)]


def constraint_force(multiplier: float, t: mpf) -> mpf:
    """Largest component of the force lambda (-u, -u, 1)."""
    return abs(mpf(float(multiplier))) * max(1, U0 * exp(t))
