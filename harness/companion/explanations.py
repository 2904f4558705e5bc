"""Plain words for each equation of the paper; between dollar signs stands TeX."""

WORDS = {
    "1": "The constraints tie the coordinates to each other, to the time and to the controls. Whoever turns a control "
    "moves the surface on which the system has to stay.",
    "2": "Newton's law in any coordinates: the left side is what inertia asks for, the right side is what pushes. "
    "Each constraint pushes across its own surface, $\\partial f_\\beta/\\partial q_s$, with a strength "
    "$\\lambda_\\beta$, its multiplier, that nobody knows beforehand.",
    "3a": "The kinetic energy, sorted by powers of the velocities. The mass matrix $A$ belongs to the squares, $B$ to "
    "the first powers and $T_0$ to what is left when nothing moves relative to the coordinates; $B$ and $T_0$ are "
    "there when the coordinates themselves move.",
    "3": "Equation (2) with the split of $T$ put in and differentiated out. Everything that contains an acceleration "
    "stands on the left, so that the accelerations can be solved for.",
    "4": "Equation (3) multiplied by the inverse of the mass matrix. The accelerations are known now as soon as the "
    "multipliers are.",
    "5": "What the inverse of the mass matrix means: times $A$ it gives the unit matrix. It exists because every "
    "motion costs kinetic energy.",
    "6": "Where the mass matrix changes from place to place, motion itself makes forces: the centrifugal and Coriolis "
    "terms of curved coordinates. The Christoffel symbols are their coefficients. In Cartesian coordinates the mass "
    "matrix is constant and there are none.",
    "7": "A quantity that stays zero has rates that are zero, too. The second rate of the constraints contains the "
    "accelerations, of the coordinates and of the controls: this is how a control that is turned ever faster is "
    "felt by the system.",
    "8": "Equations (4) and (7) both know the accelerations. Put the first into the second, and what remains are "
    "linear equations for the multipliers alone, one for each constraint.",
    "8 multipliers": "The same equations, solved. Every multiplier is known from the state and from the controls and "
    "their rates: the constraints push exactly as hard as it takes to keep them.",
    "9": "What the constraints do to each coordinate. In Cartesian coordinates these are the pulls and pushes of "
    "strings, rods and rails.",
    "10": "Put $\\lambda = 0$ into (8): on a free motion the given forces alone already keep the constraints, which "
    "then accompany the system and never push. It is a condition on the state and on the controls with their first "
    "two rates.",
    "10 condition of free motion under the control law": "The left side of (10) with the control law put in: a "
    "function of the state and the time. The motion is free exactly where it stays zero.",
    "Lagrange's equations on a free motion": "Equation (2) without reactions: the left side is inertia, the right side "
    "the given forces, and that is all.",
    "11": "The solved multipliers put back into (4): the accelerations as functions of the time, the state and the "
    "controls with their rates, and nothing unknown is left. From here on it is a problem of initial values.",
    "12": "Where the motion begins. Only part of it can be chosen freely: the rest follows from the constraints by "
    "(19).",
    "13": "Equation (11) at the initial instant: the first thing that the system does, computed before anything has "
    "moved.",
    "18": "The motion as a Taylor series. Its second-order term is half the initial acceleration (13); each further "
    "term takes one more rate of (11) along the motion.",
    "19": "Initial coordinates have to satisfy the constraints, and initial velocities their first rate. What a scene "
    "leaves open is solved for here.",
    "14 kinetic energy": "Three coordinates, each with the kinetic energy of a unit mass.",
    "14 generalized forces": "A force like that of a spring on the first coordinate, one like friction on the second; "
    "both depend on the sums $q_1 + q_2$ and $\\dot q_1 + \\dot q_2$.",
    "14 constraint": "The third coordinate is a multiple of the sum of the others, and the control says how large a "
    "multiple.",
    "15": "The one control law under which the multiplier vanishes whatever the motion is.",
    "16": "Equation (11) for the example: the multiplier is eliminated, and only the state and the control remain.",
    "17": "Equation (16) at the initial instant, under the control law $u = u_0 + t$.",
    "condition of free motion of the example": "Equation (10) for the example.",
    "equation of motion of q1": "Equation (2) for the first coordinate: spring and reaction.",
    "equation of motion of q2": "Equation (2) for the second coordinate: damping and reaction.",
    "equation of motion of q3": "Equation (2) for the third coordinate: nothing but the reaction acts on it.",
    "multiplier": "Equation (8) for the example, solved for its one multiplier.",
}


def words(number: str, name: str) -> str:
    """Plain words for an equation.

    Parameters
    ----------
    number : str
        The paper's number; may be empty.
    name : str
        What the equation is: some numbers stand for several.

    Returns
    -------
    str
        One or two sentences; empty where the name says it all.
    """
    return WORDS.get(f"{number} {name}".strip(), WORDS.get(number, ""))
