"""Random systems with every kind of term, through Maxima and the cross-check.

Coordinates q1 ... qn, controls u1 ... ualpha. The kinetic energy has a mass matrix that may
depend on coordinates, time and controls, a part linear in the velocities and one free of them,
both with control rates; potentials may contain velocities; each constraint gives one of the last
coordinates in terms of the first ones, time and controls.
"""

import re
from dataclasses import dataclass
from itertools import combinations_with_replacement, pairwise
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, example, given, settings
from hypothesis import strategies as st

from holonom.crosscheck.check import check_record
from holonom.crosscheck.report import Verdict
from holonom.record import derived_record
from holonom.source import Source

SYSTEMS, MANY_SYSTEMS = 3, 40
"""Each is a run of Maxima."""

CLOSED_FORM_SIZE = 300
"""Less than what is written out otherwise: some of the systems exceed it, and none takes long."""


@dataclass(frozen=True)
class SystemText:
    """A system in the language of scene files."""

    coordinates: list[str]
    controls: list[str]
    kinetic_energy: str
    potential_energy: str
    forces: list[str]
    constraints: list[str]
    controls_with_law: list[str]

    def scene_file(self) -> str:
        n, g = len(self.coordinates), len(self.constraints)
        written = " ".join([self.kinetic_energy, self.potential_energy, *self.forces, *self.constraints])
        controls, parameters = (
            [name for name in names if re.search(rf"\b{name}\b", written)] for names in (self.controls, ["c0"])
        )
        law = [f"{u} = c0 + {i}*t/3" for i, u in enumerate(self.controls_with_law, start=1) if u in controls]
        chosen = [x for q in self.coordinates[: n - g] for x in (f"{q} = 1/3", f"dot({q}) = -2/5")]
        return f"""
            load("holonom.mac")$
            closed_form_size : {CLOSED_FORM_SIZE}$
            system : holonomic_system(
              coordinates = [{", ".join(self.coordinates)}],
              controls = [{", ".join(controls)}],
              parameters = [{", ".join(parameters)}],
              kinetic_energy = {self.kinetic_energy},
              potential_energy = {self.potential_energy},
              forces = [{", ".join(self.forces)}],
              constraints = [{", ".join(self.constraints)}])$
            random_scene : holonomic_scene(system,
              control_law = [{", ".join(law)}],
              parameter_values = [{"c0 = 3/4" if parameters or law else ""}],
              initial_state = [{", ".join(chosen)}])$
        """


def sums_of(terms: list[str], most: int) -> st.SearchStrategy[str]:
    """A sum of one term or a few, with small coefficients."""
    coefficient = st.sampled_from(["1", "-1/2", "2", "c0"])
    term = st.builds("{}*{}".format, coefficient, st.sampled_from(terms))
    return st.lists(term, min_size=1, max_size=most).map(" + ".join)


@st.composite
def systems(draw: st.DrawFn) -> SystemText:
    n = draw(st.sampled_from([3, 2, 4]))
    g = draw(st.sampled_from([1, 0, 2] if n > 2 else [1, 0]))
    alpha = draw(st.sampled_from([1, 2, 0]))
    q = [f"q{s}" for s in range(1, n + 1)]
    v = [f"dot({x})" for x in q]
    u = [f"u{i}" for i in range(1, alpha + 1)]
    du = [f"dot({x})" for x in u]
    of_place = ["t", *q, *u, *(f"sin({x})" for x in q), *(f"{x}*t" for x in q + u)]
    of_motion = [*of_place, *du, *v]
    diagonal = [f"(2 + ({draw(sums_of(of_place, 1))})^2)*{x}^2/2" for x in v]
    coupled = draw(sums_of([f"{a}*{b}/4" for a, b in pairwise(v)] or ["0"], 1))
    linear = draw(sums_of([f"{a}*{x}" for a in [*of_place, *du] for x in v], 1))
    rest = draw(sums_of([f"{a}^2" for a in [*of_place, *du]], 1))
    independent = q[: n - g]
    movers = [*independent, *u, "t"]
    of_independent = [*movers, *(f"{x}*{y}" for x, y in combinations_with_replacement(movers, 2))]
    return SystemText(
        coordinates=q,
        controls=u,
        kinetic_energy=" + ".join([*diagonal, coupled, linear, rest]),
        potential_energy=draw(sums_of([f"{x}^2" for x in q] + [f"{q[0]}*{v[-1]}"], 2)),
        forces=[draw(sums_of(of_motion, 1)) for _ in q],
        constraints=[f"{x} - ({draw(sums_of(of_independent, 2))})" for x in q[n - g :]],
        controls_with_law=draw(st.sampled_from([u, u[:1]])),
    )


# Every second derivative of T, V and f that the paper's equations name is there, and different from the others.
EVERY_TERM = SystemText(
    coordinates=["q1", "q2"],
    controls=["u1"],
    kinetic_energy="(2 + q2*u1 + t)*dot(q1)^2/2 + (3 + dot(u1)^2)*dot(q2)^2/2 + q1*dot(q1)*dot(q2)/4"
    " + (t*u1 + q2*t)*dot(q1) + q1*dot(u1)*dot(q2) + q1^2*q2*u1",
    potential_energy="q1*q2 + q1^2*u1*dot(q2)",
    forces=["-q2*dot(q1)", "t*dot(u1)"],
    constraints=["q2 - (q1^2*u1 + t*u1 + 2*q1*t + 3*t^2 + u1^2)"],
    controls_with_law=["u1"],
)


RANDOM = settings(
    derandomize=True,
    phases=[Phase.explicit, Phase.generate],  # shrinking a failure would run Maxima hundreds of times
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)


@settings(RANDOM, max_examples=SYSTEMS)
@given(system=systems())
@example(system=EVERY_TERM)
def test_no_equation_of_a_random_system_disagrees(tmp_path: Path, system: SystemText) -> None:
    require_agreement(tmp_path / "random.mac", system)


@pytest.mark.long
@settings(RANDOM, max_examples=MANY_SYSTEMS)
@given(system=systems())
def test_no_equation_of_many_random_systems_disagrees(tmp_path: Path, system: SystemText) -> None:
    require_agreement(tmp_path / "random.mac", system)


def require_agreement(scene: Path, system: SystemText) -> None:
    scene.write_text(system.scene_file(), encoding="utf-8")
    source = Source(scene)
    report = check_record(derived_record(source), source.description())
    assert not report.disagreements, [found for found in report.verdicts if found.verdict is Verdict.DISAGREES]
