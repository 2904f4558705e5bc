"""Planar linkages through Maxima and the cross-check: bars between points, in loops and chains.

No constraint is written in solved form. The initial values of the others follow from those of some coordinates.
"""

import random
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from holonom.crosscheck.check import check_record
from holonom.crosscheck.report import Verdict
from holonom.record import derived_record
from holonom.source import Source

ANCHORS = ((0, 0), (3, 0))
FEWEST = 1e-2  # smallest singular value of a Jacobian that counts as regular
POINTS = 4


def linkage(seed: int) -> str:
    """Return a scene file of a linkage whose given coordinates determine the others."""
    chance = random.Random(seed)
    while True:
        places = [(chance.randint(-4, 4), chance.randint(1, 6)) for _ in range(chance.randint(2, POINTS))]
        ends = [*ANCHORS, *places]
        pairs = [(i, k) for i, k in combinations(range(len(ends)), 2) if k >= len(ANCHORS) and ends[i] != ends[k]]
        bars = chance.sample(pairs, min(len(pairs), chance.randint(len(places), 2 * len(places) - 1)))
        n = 2 * len(places)
        free = sorted(chance.sample(range(n), n - len(bars)))
        if np.linalg.svd(jacobian(ends, bars)[:, [k for k in range(n) if k not in free]])[1].min() > FEWEST:
            return scene_file(ends, bars, free)


def jacobian(ends, bars):
    found = np.zeros((len(bars), 2 * len(ends)))
    for row, (i, k) in enumerate(bars):
        for axis in range(2):
            found[row, 2 * i + axis] = 2 * (ends[i][axis] - ends[k][axis])
            found[row, 2 * k + axis] = -found[row, 2 * i + axis]
    return found[:, 2 * len(ANCHORS) :]


def scene_file(ends, bars, free) -> str:
    squares = [sum((ends[i][a] - ends[k][a]) ** 2 for a in range(2)) for i, k in bars]
    return scene_text(ends, bars, squares, free, {k: f"{1 + k}/5" for k in free})


def scene_text(ends, bars, squares, free, velocities) -> str:
    names = [*map(str, ends[: len(ANCHORS)]), *(f"(x{k}, y{k})" for k in range(1, len(ends) - 1))]
    axes = [name.strip("()").split(", ") for name in names]
    coordinates = [name for each in axes[len(ANCHORS) :] for name in each]
    values = [value for each in ends[len(ANCHORS) :] for value in each]
    constraints = [f"({axes[i][0]} - {axes[k][0]})^2 + ({axes[i][1]} - {axes[k][1]})^2 - L{j}"
                   for j, (i, k) in enumerate(bars)]  # fmt: skip
    given = [f"{coordinates[k]} = {values[k]}" for k in free]
    given += [f"dot({coordinates[k]}) = {value}" for k, value in velocities.items()]
    guessed = [f"{name} = {values[k]} + 1/90" for k, name in enumerate(coordinates) if k not in free]
    parameters = [f"L{j}" for j in range(len(bars))]
    known = [f"{name} = {value}" for name, value in zip(parameters, squares, strict=True)]
    return f"""
        load("holonom.mac")$
        closed_form_size : 300$
        system : holonomic_system(
          coordinates = [{", ".join(coordinates)}],
          parameters = [{", ".join(parameters)}],
          kinetic_energy = ({" + ".join(f"dot({name})^2" for name in coordinates)})/2,
          potential_energy = {" + ".join(coordinates[1::2])},
          constraints = [{", ".join(constraints)}])$
        moving : holonomic_scene(system,
          parameter_values = [{", ".join(known)}],
          initial_state = [{", ".join(given)}],
          initial_guess = [{", ".join(guessed)}])$
    """


PEAUCELLIER = [(0, 3), (0, 4), (2, 3), (2, 4), (3, 5), (4, 5), (1, 2)]  # ground 0, centre 1; inner, two tips, outer


def peaucelliers_linkage() -> str:
    """Return the scene file of a linkage for whose velocities linsolve of Maxima 5.46 gives wrong values."""
    h = "sqrt(23)/4"
    ends = [(0, 0), (1, 0), (2, 0), ("11/4", h), ("11/4", f"-{h}"), ("7/2", 0)]
    return scene_text(ends, PEAUCELLIER, [9, 9, 2, 2, 2, 2, 1], [0, 1, 6, 7], {1: 1, 0: 0})


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(1, 20))])
def test_no_equation_of_a_random_linkage_disagrees(seed: int, tmp_path: Path) -> None:
    assert disagreements(linkage(seed), tmp_path) == []


def test_no_equation_of_peaucelliers_linkage_disagrees(tmp_path: Path) -> None:
    assert disagreements(peaucelliers_linkage(), tmp_path) == []


def disagreements(scene: str, folder: Path) -> list[str]:
    file = folder / "linkage.mac"
    file.write_text(scene, encoding="utf-8")
    source = Source(file)
    report = check_record(derived_record(source), source.description())
    return [each.detail for each in report.verdicts if each.verdict is Verdict.DISAGREES]
