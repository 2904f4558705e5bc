"""Which Maxima functions do which step: the id of an equation, and where it is derived."""

from pathlib import Path

from .excerpts import Excerpt, excerpt

STEPS = {
    "constraints": {"maxima/system.mac": ("constraint_jacobian",), "maxima/derivation/derive.mac": ("equals_zero",)},
    "lagrange_equations": {
        "maxima/derivation/equations_of_motion.mac": ("lagrangian_derivative", "lagrange_equations", "reaction"),
    },
    "kinetic_energy": {
        "maxima/derivation/kinetic_energy.mac": ("mass_matrix", "linear_coefficients", "velocity_free_part"),
    },
    "expanded_equations": {
        "maxima/derivation/equations_of_motion.mac": ("expanded_equations", "right_side_terms", "gyroscopic_terms"),
    },
    "driven_accelerations": {"maxima/derivation/equations_of_motion.mac": ("accelerations_with_multipliers",)},
    "inverse_mass_matrix": {"maxima/derivation/equations_of_motion.mac": ("inverse_mass_matrix",)},
    "christoffel_symbols": {"maxima/derivation/christoffel.mac": ("christoffel_first_kind", "christoffel_symbols")},
    "constraint_accelerations": {
        "maxima/derivation/constraint_acceleration.mac": (
            "constraint_acceleration",
            "second_rate_terms",
            "quadratic_form",
        ),
    },
    "multiplier_equations": {"maxima/derivation/multipliers.mac": ("multiplier_equations",)},
    "multipliers": {"maxima/derivation/multipliers.mac": ("solve_multipliers",)},
    "constraint_forces": {"maxima/derivation/multipliers.mac": ("constraint_forces",)},
    "free_motion_condition": {"maxima/derivation/free_motion.mac": ("free_motion_condition",)},
    "free_motion_residual": {"maxima/derivation/free_motion.mac": ("free_motion_condition",)},
    "accelerations": {"maxima/derivation/derive.mac": ("closed_forms",)},
    "initial_state": {"maxima/derivation/initial_state.mac": ("consistent_initial_state", "completed")},
    "initial_accelerations": {
        "maxima/derivation/initial_motion.mac": ("under_control_law", "at_initial_instant", "initial_derivatives"),
    },
    "initial_series": {"maxima/derivation/initial_motion.mac": ("rate_along_motion", "initial_series")},
    "determined_initial_values": {
        "maxima/derivation/initial_state.mac": ("determined_initial_values", "linear_solution"),
    },
}


def step(root: Path, name: str) -> tuple[Excerpt, ...]:
    """The Maxima lines that derive an equation, given its id.

    Raises
    ------
    HolonomError
        A function that should be there is not.
    """
    files = STEPS[name]
    return tuple(excerpt(root, file, function) for file, functions in files.items() for function in functions)
