"""Plain words for each equation of the paper; between dollar signs stands TeX."""

WORDS = {
    "constraints": (
        "The constraints tie the coordinates to each other, to the time and to the controls. Whoever turns a "
        "control moves the surface on which the system has to stay."
    ),
    "lagrange_equations": (
        "Newton's law in any coordinates: the left side is what inertia asks for, the right side is what pushes. "
        "Each constraint pushes across its own surface, $\\partial f_\\beta/\\partial q_s$, with a strength "
        "$\\lambda_\\beta$, its multiplier, that nobody knows beforehand."
    ),
    "kinetic_energy": (
        "The kinetic energy, sorted by powers of the velocities. The mass matrix $A$ belongs to the squares, $B$ "
        "to the first powers and $T_0$ to what is left when nothing moves relative to the coordinates; $B$ and "
        "$T_0$ are there when the coordinates themselves move."
    ),
    "expanded_equations": (
        "Equation (2) with the split of $T$ put in and differentiated out. Everything that contains an "
        "acceleration stands on the left, so that the accelerations can be solved for."
    ),
    "driven_accelerations": (
        "Equation (3) multiplied by the inverse of the mass matrix. The accelerations are known now as soon as "
        "the multipliers are."
    ),
    "inverse_mass_matrix": (
        "What the inverse of the mass matrix means: times $A$ it gives the unit matrix. It exists because every "
        "motion costs kinetic energy."
    ),
    "christoffel_symbols": (
        "Where the mass matrix changes from place to place, motion itself makes forces: the centrifugal and "
        "Coriolis terms of curved coordinates. The Christoffel symbols are their coefficients. In Cartesian "
        "coordinates the mass matrix is constant and there are none."
    ),
    "constraint_accelerations": (
        "A quantity that stays zero has rates that are zero, too. The second rate of the constraints contains "
        "the accelerations, of the coordinates and of the controls: this is how a control that is turned ever "
        "faster is felt by the system."
    ),
    "multiplier_equations": (
        "Equations (4) and (7) both know the accelerations. Put the first into the second, and what remains are "
        "linear equations for the multipliers alone, one for each constraint."
    ),
    "multipliers": (
        "The same equations, solved. Every multiplier is known from the state and from the controls and their "
        "rates: the constraints push exactly as hard as it takes to keep them."
    ),
    "constraint_forces": (
        "What the constraints do to each coordinate. In Cartesian coordinates these are the pulls and pushes of "
        "strings, rods and rails."
    ),
    "free_motion_condition": (
        "Put $\\lambda = 0$ into (8): on a free motion the given forces alone already keep the constraints, which "
        "then accompany the system and never push. It is a condition on the state and on the controls with their "
        "first two rates."
    ),
    "free_motion_residual": (
        "The left side of (10) with the control law put in: a function of the state and the time. The motion is "
        "free exactly where it stays zero."
    ),
    "accelerations": (
        "The solved multipliers put back into (4): the accelerations as functions of the time, the state and the "
        "controls with their rates, and nothing unknown is left. From here on it is a problem of initial values."
    ),
    "initial_state": (
        "Where the motion begins. Only part of it can be chosen freely: the rest follows from the constraints by (19)."
    ),
    "initial_accelerations": (
        "Equation (11) at the initial instant: the first thing that the system does, computed before anything "
        "has moved."
    ),
    "initial_series": (
        "The motion as a Taylor series. Its second-order term is half the initial acceleration (13); each "
        "further term takes one more rate of (11) along the motion."
    ),
    "determined_initial_values": (
        "Initial coordinates have to satisfy the constraints, and initial velocities their first rate. What a "
        "scene leaves open is solved for here."
    ),
}
"""Of the equations of a record, by id."""

ON_PRINT = {
    "Lagrange's equations on a free motion": (
        "Equation (2) without reactions: the left side is inertia, the right side the given forces, and that is all."
    ),
    "condition on the kinetic energy": (
        "What lets (2) be solved for the accelerations: their coefficients in it are the second derivatives of $T$ by "
        "the velocities."
    ),
    "condition on the mass matrix": (
        "The same condition for the split $T$: the mass matrix $A$ has an inverse. A positive definite one always has."
    ),
    "condition on the constraints": (
        "What lets (8) be solved for the multipliers. It asks that the constraints be independent, their gradients "
        "$\\partial f_\\beta/\\partial q_s$ linearly independent; for a positive definite $A$ that is enough."
    ),
    "14 kinetic energy": "Three coordinates, each with the kinetic energy of a unit mass.",
    "14 generalized forces": (
        "A force like that of a spring on the first coordinate, one like friction on the second; both depend on "
        "the sums $q_1 + q_2$ and $\\dot q_1 + \\dot q_2$."
    ),
    "14 constraint": (
        "The third coordinate is a multiple of the sum of the others, and the control says how large a multiple."
    ),
    "15": "The one control law under which the multiplier vanishes whatever the motion is.",
    "16": "Equation (11) for the example: the multiplier is eliminated, and only the state and the control remain.",
    "17": "Equation (16) at the initial instant, under the control law $u = u_0 + t$.",
    "condition of free motion of the example": "Equation (10) for the example.",
    "equation of motion of q1": "Equation (2) for the first coordinate: spring and reaction.",
    "equation of motion of q2": "Equation (2) for the second coordinate: damping and reaction.",
    "equation of motion of q3": "Equation (2) for the third coordinate: nothing but the reaction acts on it.",
    "multiplier": "Equation (8) for the example, solved for its one multiplier.",
    "12": WORDS["initial_state"],
    "13": WORDS["initial_accelerations"],
    "18": WORDS["initial_series"],
    "19": WORDS["determined_initial_values"],
}
"""Of equations that only the paper prints, by number or by number and name."""


def words(name: str) -> str:
    """Plain words, one or two sentences, for an equation of a record, given its id."""
    return WORDS[name]


def words_on_print(number: str, name: str) -> str:
    """The same for an equation as the paper prints it; empty where its name says it all."""
    return ON_PRINT.get(f"{number} {name}".strip(), ON_PRINT.get(number, ""))
