"""The planar chain that all peers are given: N unit masses on unit links, the first link of length u."""

from itertools import pairwise
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

GRAVITY = "9.81"


def names(links: int) -> tuple[list[str], list[str], list[str]]:
    """Coordinates, velocities and multipliers, in the order of every function here."""
    coordinates = [f"{axis}{k}" for k in range(1, links + 1) for axis in "xy"]
    return coordinates, [f"dot({q})" for q in coordinates], [f"lambda{k}" for k in range(1, links + 1)]


def inputs(links: int) -> list[str]:
    """Names of the inputs."""
    coordinates, velocities, _ = names(links)
    return ["t", *coordinates, *velocities, "u", "dot(u)", "ddot(u)"]


def outputs(links: int) -> list[str]:
    """Names of the outputs."""
    coordinates, _, multipliers = names(links)
    return [*(f"ddot({q})" for q in coordinates), *multipliers]


def constraints(q: list, u: object) -> list:
    """Left sides of (|d_k|^2 - length^2)/2 = 0, in any algebra whose coordinates are given."""
    points = [(0, 0), *zip(q[::2], q[1::2], strict=True)]
    squares = [(x - x0) ** 2 + (y - y0) ** 2 for (x0, y0), (x, y) in pairwise(points)]
    return [(squares[0] - u**2) / 2, *((square - 1) / 2 for square in squares[1:])]


def consistent_point(links: int, seed: int) -> NDArray[np.float64]:
    """Values of the inputs at a random state that satisfies the constraints and their first derivatives."""
    draw = np.random.default_rng(seed)
    u, du, ddu = 1.3, 0.4, -0.2
    angles, rates = draw.uniform(-3, 3, links), draw.normal(size=links)
    lengths = np.array([u, *np.ones(links - 1)])[:, None]
    directions = np.array([(cos(angle), sin(angle)) for angle in angles])
    normals = directions @ np.array([[0, 1], [-1, 0]])
    velocities = lengths * rates[:, None] * normals
    velocities[0] += du * directions[0]
    positions = np.cumsum(lengths * directions, axis=0)
    return np.array([0.0, *positions.ravel(), *np.cumsum(velocities, axis=0).ravel(), u, du, ddu])
