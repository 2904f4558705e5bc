"""Which Maxima functions do which step: the paper's number of an equation, and where it is derived."""

from pathlib import Path

from .excerpts import Excerpt, excerpt

STEPS = {
    "1": {"maxima/system.mac": ("constraint_jacobian",), "maxima/derivation/derive.mac": ("equals_zero",)},
    "2": {"maxima/derivation/equations_of_motion.mac": ("lagrangian_derivative", "lagrange_equations", "reaction")},
    "3a": {"maxima/derivation/kinetic_energy.mac": ("mass_matrix", "linear_coefficients", "velocity_free_part")},
    "3": {"maxima/derivation/equations_of_motion.mac": ("expanded_equations", "right_side_terms", "gyroscopic_terms")},
    "4": {"maxima/derivation/equations_of_motion.mac": ("accelerations_with_multipliers",)},
    "5": {"maxima/derivation/equations_of_motion.mac": ("inverse_mass_matrix",)},
    "6": {"maxima/derivation/christoffel.mac": ("christoffel_first_kind", "christoffel_symbols")},
    "7": {
        "maxima/derivation/constraint_acceleration.mac": (
            "constraint_acceleration",
            "second_rate_terms",
            "quadratic_form",
        )
    },
    "8": {"maxima/derivation/multipliers.mac": ("multiplier_equations",)},
    "8 multipliers": {"maxima/derivation/multipliers.mac": ("solve_multipliers",)},
    "9": {"maxima/derivation/multipliers.mac": ("constraint_forces",)},
    "10": {"maxima/derivation/free_motion.mac": ("free_motion_condition",)},
    "11": {"maxima/derivation/derive.mac": ("closed_forms",)},
    "12": {"maxima/derivation/initial_state.mac": ("consistent_initial_state", "completed")},
    "13": {
        "maxima/derivation/initial_motion.mac": ("under_control_law", "at_initial_instant", "initial_derivatives"),
    },
    "18": {"maxima/derivation/initial_motion.mac": ("rate_along_motion", "initial_series")},
    "19": {"maxima/derivation/initial_state.mac": ("determined_initial_values", "linear_solution")},
}


def step(root: Path, number: str, name: str) -> tuple[Excerpt, ...]:
    """The Maxima lines that derive an equation.

    Parameters
    ----------
    root : Path
        The repository.
    number : str
        The paper's number.
    name : str
        What the equation is: some numbers stand for several.

    Raises
    ------
    HolonomError
        A function that should be there is not.
    """
    files = STEPS.get(f"{number} {name}") or STEPS[number]
    return tuple(excerpt(root, file, name) for file, names in files.items() for name in names)
