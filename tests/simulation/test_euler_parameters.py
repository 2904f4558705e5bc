"""Motions whose mass matrix only the constraints make regular, against rigid-body mechanics."""

import numpy as np
from scipy.integrate import solve_ivp

from holonom.confined import Limits
from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request, Solve
from holonom.simulation.request import EngineName, SimulationRequest
from holonom.simulation.simulate import simulate

# A free rigid body in Euler parameters: A has rank 3 of 4, and starts with a pivot that is zero at e = (1, 0, 0, 0).
EULER_PARAMETERS = """
load("holonom.mac")$
om1 : 2*(-e1*dot(e0) + e0*dot(e1) + e3*dot(e2) - e2*dot(e3))$
om2 : 2*(-e2*dot(e0) - e3*dot(e1) + e0*dot(e2) + e1*dot(e3))$
om3 : 2*(-e3*dot(e0) + e2*dot(e1) - e1*dot(e2) + e0*dot(e3))$
system : holonomic_system(coordinates = [e0, e1, e2, e3], parameters = [I1, I2, I3],
  kinetic_energy = (I1*om1^2 + I2*om2^2 + I3*om3^2)/2, constraints = [e0^2 + e1^2 + e2^2 + e3^2 - 1])$
run : holonomic_scene(system, parameter_values = [I1 = 1, I2 = 2, I3 = 3],
  initial_state = [e0 = 1, e1 = 0, e2 = 0, e3 = 0, dot(e0) = 0, dot(e1) = 1/10, dot(e2) = 1, dot(e3) = 1/10],
  time_span = [0, 10])$
"""


def eulers_equations(end: float) -> np.ndarray:
    """Angular velocities in the body's frame by Euler's equations, the moments of inertia 1, 2, 3."""

    def rates(_: float, w: np.ndarray) -> list[float]:
        return [-w[1] * w[2], w[2] * w[0], -w[0] * w[1] / 3]

    return solve_ivp(rates, (0.0, end), [0.2, 2.0, 0.2], "DOP853", [end], rtol=3e-14, atol=1e-15).y[:, 0]


def angular_velocity(e: np.ndarray, rate: np.ndarray) -> np.ndarray:
    matrix = np.array([[-e[1], e[0], e[3], -e[2]], [-e[2], -e[3], e[0], e[1]], [-e[3], e[2], -e[1], e[0]]])
    return 2 * matrix @ rate


def test_a_rigid_body_in_euler_parameters_follows_eulers_equations(write_scene):
    for solve in Solve:
        problem = motion_problem(write_scene(EULER_PARAMETERS), Request(solve=solve), Limits())
        motion = simulate(problem, SimulationRequest(samples=3))
        e = np.array([motion.coordinates[f"e{i}"][-1] for i in range(4)])
        rate = np.array([motion.velocities[f"dot(e{i})"][-1] for i in range(4)])
        np.testing.assert_allclose(angular_velocity(e, rate), eulers_equations(10.0), atol=3e-11)
        assert [leg.engine for leg in motion.report.legs] == [EngineName.TAYLOR]
