"""Random systems with every kind of term, through Maxima and the cross-check.

Coordinates q1 ... qn, controls u1 ... ualpha. The kinetic energy has a mass matrix that may
depend on coordinates, time and controls, a part linear in the velocities and one free of them,
both with control rates; potentials may contain velocities; each constraint gives one of the last
coordinates in terms of the first ones, time and controls.
"""

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from harness.crosscheck import Verdict, check_record
from harness.maxima import run_scene
from harness.record import read_record

SYSTEMS = 10
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

    def scene_file(self) -> str:
        n, g = len(self.coordinates), len(self.constraints)
        law = [f"{u} = c0 + {i}*t/3" for i, u in enumerate(self.controls, start=1)]
        chosen = [x for q in self.coordinates[: n - g] for x in (f"{q} = 1/3", f"dot({q}) = -2/5")]
        return f"""
            load("holonom.mac")$
            closed_form_size : {CLOSED_FORM_SIZE}$
            system : holonomic_system(
              coordinates = [{", ".join(self.coordinates)}],
              controls = [{", ".join(self.controls)}],
              parameters = [c0],
              kinetic_energy = {self.kinetic_energy},
              potential_energy = {self.potential_energy},
              forces = [{", ".join(self.forces)}],
              constraints = [{", ".join(self.constraints)}])$
            random_scene : holonomic_scene(system,
              control_law = [{", ".join(law)}],
              parameter_values = [c0 = 3/4],
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
    of_independent = [*independent, *u, "t", *(f"{x}*{y}" for x in independent for y in [*u, x])]
    return SystemText(
        coordinates=q,
        controls=u,
        kinetic_energy=" + ".join([*diagonal, coupled, linear, rest]),
        potential_energy=draw(sums_of([f"{x}^2" for x in q] + [f"{q[0]}*{v[-1]}"], 2)),
        forces=[draw(sums_of(of_motion, 1)) for _ in q],
        constraints=[f"{x} - ({draw(sums_of(of_independent, 2))})" for x in q[n - g :]],
    )


@settings(
    max_examples=SYSTEMS,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(system=systems())
def test_no_equation_of_a_random_system_disagrees(tmp_path: Path, system: SystemText) -> None:
    scene = tmp_path / "random.mac"
    scene.write_text(system.scene_file(), encoding="utf-8")
    report = check_record(read_record(run_scene(scene)))
    assert not report.disagreements, [found for found in report.verdicts if found.verdict is Verdict.DISAGREES]
