"""Notation: the paper's symbols, their names in Maxima and in Python."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..chapter import Chapter, Page

NOTATION_FILE = "maxima/notation.mac"


@dataclass(frozen=True)
class Symbol:
    """A symbol of the paper and its names.

    Attributes
    ----------
    paper : str
        TeX.
    meaning : str
    scene : str
        As it is written in a scene file and printed by Maxima.
    maxima : str
        The function of the library that gives it; empty where the description does.
    python : str
        Where the record has it.
    """

    paper: str
    meaning: str
    scene: str
    maxima: str
    python: str


SYMBOLS = (
    Symbol("q_s", "coordinates", "q1, q2, ...", "", "system.coordinates"),
    Symbol(r"\dot q_s,\ \ddot q_s", "velocities, accelerations", "dot(q1), ddot(q1)", "", "system.velocities"),
    Symbol(r"u_\rho", "controls", "u", "", "system.controls"),
    Symbol(r"\dot u_\rho,\ \ddot u_\rho", "their rates", "dot(u), ddot(u)", "", "system.control_rates"),
    Symbol("t", "time", "t", "", "system.time"),
    Symbol("T", "kinetic energy", "kinetic_energy = ...", "kinetic_energy", "system.kinetic_energy"),
    Symbol("Q_s", "generalized forces", "forces = [...]", "generalized_forces", "system.forces"),
    Symbol(r"f_\beta", "constraints", "constraints = [...]", "", "system.constraints"),
    Symbol(
        r"\partial f_\beta/\partial q_s",
        "constraint Jacobian",
        "",
        "constraint_jacobian",
        'equations["lagrange_equations"]',
    ),
    Symbol(r"\lambda_\beta", "multipliers", "lambda1, lambda2, ...", "solve_multipliers", "system.multipliers"),
    Symbol("A_{sk}", "mass matrix", "A[s,k]", "mass_matrix", 'equations["kinetic_energy"]'),
    Symbol("B_s", "coefficients of the velocities in T", "B[s]", "linear_coefficients", 'equations["kinetic_energy"]'),
    Symbol("T_0", "T without velocities", "T0", "velocity_free_part", 'equations["kinetic_energy"]'),
    Symbol(
        "A^{ls}",
        "inverse of the mass matrix",
        "A_inverse[l,s]",
        "inverse_mass_matrix",
        'equations["inverse_mass_matrix"]',
    ),
    Symbol(
        "[k,m;s]",
        "Christoffel symbols of the first kind",
        "christoffel[k,m,s]",
        "christoffel_symbols",
        'equations["christoffel_symbols"]',
    ),
    Symbol(r"\Lambda_s", "constraint forces", "Lambda[s]", "constraint_forces", 'equations["constraint_forces"]'),
    Symbol("F_l", "accelerations without multipliers", "ddot(q1) = ...", "closed_forms", 'equations["accelerations"]'),
    Symbol(r"q_{s0},\ \dot q_{s0}", "initial state", "q1_0, dot(q1)_0", "initial", "scene.initial_state"),
)


def chapter(root: Path) -> Chapter:
    """The chapter, with the Maxima files under a root."""

    def page(results: Mapping[str, Any]) -> Page:
        return Page({"symbols": SYMBOLS, "file": NOTATION_FILE}, sources=(NOTATION_FILE,))

    return Chapter(
        slug="notation",
        title="Notation",
        aim="The paper's symbols, and their names in Maxima and in Python.",
        template="notation.html",
        runs={},
        page=page,
    )
