"""Records of the examples, each derived once, and of a system with every kind of term."""

from pathlib import Path

import pytest

from holonom.description import Description
from holonom.record import Record, derived_record
from holonom.source import Source

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"

# A(q,t,u), B, T0, control rates in T, forces with velocities; a start that is not t = 0; a scene without all effects.
EVERY_TERM = """
load("holonom.mac")$
system : holonomic_system(
  coordinates = [x, y], controls = [u], parameters = [m, k],
  kinetic_energy = [bare = (m + x*u + t)*dot(x)^2/2 + m*dot(y)^2/2, turning = t*u*dot(x) + x*dot(u)*dot(y) + x*u],
  potential_energy = [spring = k*x*y],
  forces = [drag = [-y*dot(x), 0], push = [0, t*dot(u)]],
  constraints = [y - x*u - t*u])$
whole : holonomic_scene(system, control_law = [u = 1 + t^2], parameter_values = [m = 2, k = 3],
  initial_state = [x = 1/2, dot(x) = 1/3], time_span = [1, 2])$
part : holonomic_scene(system, effects = [bare, push], control_law = [u = 1 + t^2], parameter_values = [m = 2, k = 3],
  initial_state = [x = 1/2, dot(x) = 1/3], time_span = [1, 2])$
"""

# Three massless hooks on one cart: what is inverted couples all four coordinates, while A couples none.
MASSLESS_HOOKS = """
load("holonom.mac")$
system : holonomic_system(
  coordinates = [x, z1, z2, z3], parameters = [m, k],
  kinetic_energy = m*dot(x)^2/2, potential_energy = k*(z1^2 + z2^2 + z3^2)/2, constraints = [z1 - x, z2 - x, z3 - x])$
"""


@pytest.fixture
def massless_hooks(write_scene) -> Source:
    return Source(write_scene(MASSLESS_HOOKS))


@pytest.fixture(
    scope="session",
    params=["paper/paper.mac", "weightless_cabin.mac", "pendulum.mac", "bead.mac"],
)
def example_source(request: pytest.FixtureRequest) -> Source:
    return Source(EXAMPLES / request.param)


@pytest.fixture(scope="session")
def example_record(example_source: Source) -> Record:
    return derived_record(example_source)


@pytest.fixture(scope="session")
def example_description(example_source: Source) -> Description:
    return example_source.description()


@pytest.fixture(scope="session")
def paper_source() -> Source:
    return Source(EXAMPLES / "paper" / "paper.mac")


@pytest.fixture(scope="session")
def paper_record(paper_source: Source) -> Record:
    return derived_record(paper_source)


@pytest.fixture(scope="session")
def paper_description(paper_source: Source) -> Description:
    return paper_source.description()


@pytest.fixture(scope="session")
def every_term_source(tmp_path_factory: pytest.TempPathFactory) -> Source:
    file = tmp_path_factory.mktemp("every") / "scene.mac"
    file.write_text(EVERY_TERM, encoding="utf-8")
    return Source(file)


@pytest.fixture(scope="session")
def every_term_record(every_term_source: Source) -> Record:
    return derived_record(every_term_source)


@pytest.fixture(scope="session")
def every_term_description(every_term_source: Source) -> Description:
    return every_term_source.description()
