"""Two systems whose multipliers are known in closed form."""

import sympy as sp

from holonom.crosscheck.system import MechanicalSystem


def symbols(names: str) -> list[sp.Symbol]:
    return [sp.Symbol(name, real=True) for name in names.split()]


def paper_example() -> MechanicalSystem:
    """Chen, Guo & Mei 2019, eq. (14)."""
    q1, q2, q3, u, t, lambda1 = symbols("q1 q2 q3 u t lambda1")
    v1, v2, v3 = symbols("dot(q1) dot(q2) dot(q3)")
    return MechanicalSystem(
        time=t,
        coordinates=(q1, q2, q3),
        controls=(u,),
        multipliers=(lambda1,),
        kinetic_energy=(v1**2 + v2**2 + v3**2) / 2,
        potential_energy=sp.Integer(0),
        forces=(-q1 - q2, -2 * (v1 + v2), sp.Integer(0)),
        constraints=(q3 - u * (q1 + q2),),
    )


def pendulum() -> MechanicalSystem:
    """A bob on a string of length u, in Cartesian coordinates."""
    x, y, u, t, m, g, lambda1, vx, vy = symbols("x y u t m g lambda1 dot(x) dot(y)")
    return MechanicalSystem(
        time=t,
        coordinates=(x, y),
        controls=(u,),
        multipliers=(lambda1,),
        kinetic_energy=m * (vx**2 + vy**2) / 2,
        potential_energy=m * g * y,
        forces=(sp.Integer(0), sp.Integer(0)),
        constraints=(x**2 + y**2 - u**2,),
    )


def charge_in_crossed_fields() -> MechanicalSystem:
    """Everything at once: A(q, t, u), B(q, u), T0, a velocity-dependent potential, dot(u) in T."""
    r, s, u, t, lambda1, lambda2, vr, vs, du = symbols("r s u t lambda1 lambda2 dot(r) dot(s) dot(u)")
    return MechanicalSystem(
        time=t,
        coordinates=(r, s),
        controls=(u,),
        multipliers=(lambda1,),
        kinetic_energy=(1 + r**2 * u**2) * vr**2 / 2
        + (2 + sp.cos(s) + t**2) * vs**2 / 2
        + r * vr * vs / 3
        + s * u * vr
        + du * r * vs
        + t * r**2 / 2,
        potential_energy=r * s - r**2 * vs,
        forces=(-u * vr, t * vr * vs),
        constraints=(s - u * r**2 - t,),
    )
