"""Equilibria over a control: branches against closed forms."""

import json

import numpy as np
import pytest

import holonom
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import Publication, require
from holonom.stability.equilibria import Equilibria, Stability

HOOP = """load(holonom)$
system : holonomic_system(coordinates = [phi], controls = [u], kinetic_energy = dot(phi)^2/2,
  potential_energy = [gravity = -10*cos(phi), turning = -sin(phi)^2*u^2/2])$
s : holonomic_scene(system, control_law = [u = 1], initial_state = [phi = 1/2, dot(phi) = 0], time_span = [0, 1])$
"""
VALUES = [0.0, 2.0, 3.1, 3.2, 5.0, 9.0]


@pytest.fixture(scope="module")
def hoop():
    return holonom.system(HOOP)


@pytest.fixture(scope="module")
def fork(hoop):
    return hoop.branches("u", VALUES, starts=40)


def test_a_fork_where_the_hoop_turns_fast(fork):
    assert fork.values == VALUES
    for u, found in zip(VALUES, fork, strict=True):
        angles = {each.coordinates["phi"]: each.stability for each in found}
        tilted = np.arccos(10 / u**2) if u**2 > 10 else 0.0
        assert sorted(angles) == pytest.approx(sorted({-tilted, 0.0, tilted, np.pi}), abs=1e-9)
        stable = [phi for phi, stability in angles.items() if stability is Stability.STABLE]
        assert sorted(stable) == pytest.approx(sorted({-tilted, tilted}), abs=1e-9)


def test_states_of_one_value_are_starts_at_the_next():
    """The exponential function leaves no polynomials, whose solutions are all starts."""
    hoop = holonom.system(HOOP.replace("-10*cos(phi)", "-10*cos(phi) + exp(cos(phi))/1000"))
    assert len(hoop.equilibria(u=9.0, starts=2)) == 1
    assert [len(found) for found in hoop.branches("u", [4.0, 9.0], starts=2)] == [2, 2]


def test_a_fold_is_not_called_stable():
    """Of V = x^4/4 - 3*x^2/2 + u*x at u = -2, where the branches -1 +- sqrt(h/3) meet."""
    cusp = holonom.system(
        """system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2,
          potential_energy = x^4/4 - 3*x^2/2 + u*x)$
        s : holonomic_scene(system, control_law = [u = 0], initial_state = [x = 1/10, dot(x) = 0])$"""
    )
    found = cusp.branches("u", [-2.0000001, -2.0]).at[1]
    fold, minimum = sorted(found, key=lambda each: each.coordinates["x"])
    assert (fold.coordinates["x"], fold.stability, fold.isolated) == (pytest.approx(-1), Stability.UNDECIDED, False)
    assert (minimum.coordinates["x"], minimum.stability, minimum.isolated) == (pytest.approx(2), Stability.STABLE, True)
    assert not found.complete


def test_a_fold_on_a_curve_is_not_called_stable():
    """On the ellipse x = 2 cos(s), y = sin(s) the force of V = u*x*y + 2*y at u = -1 is 2 (cos(2 s) - cos(s))."""
    ellipse = holonom.system(
        """system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
          potential_energy = u*x*y + 2*y, constraints = [x^2/4 + y^2 - 1])$
        s : holonomic_scene(system, control_law = [u = 1], initial_state = [x = 6/5, dot(x) = 0],
          initial_guess = [y = 4/5])$"""
    )
    found = ellipse.branches("u", [0.5, -1.0], starts=100).at[1]
    fold = max(found, key=lambda each: each.coordinates["x"])
    assert (fold.coordinates["x"], fold.stability, fold.isolated) == (pytest.approx(2), Stability.UNDECIDED, False)
    assert not found.complete


def test_a_row_for_each_state(fork):
    table = fork.to_pandas()
    assert list(table.columns) == ["u", "phi", "stability"]
    assert list(table["u"].value_counts(sort=False)) == [len(found) for found in fork] == [2, 2, 2, 4, 4, 4]


def test_documents_and_figure(fork, tmp_path):
    assert [each["controls"]["u"] for each in fork.documents()] == VALUES
    fork.plot().save(tmp_path / "fork.svg")
    figure = (tmp_path / "fork.svg").read_text()
    assert str(Stability.STABLE) in figure
    assert str(Stability.ASYMPTOTIC) not in figure
    assert str(Stability.UNSTABLE) in repr(fork)


def test_the_command_writes_a_list_of_documents(holonom_here, write_scene):
    done = holonom_here("equilibria", write_scene(HOOP), "--over", "u=3:4:2", "--starts", "40", "--json", "-")
    documents = json.loads(done.stdout)
    for each in documents:
        require(Publication.EQUILIBRIA, each, Equilibria)
    assert [len(each["found"]) for each in documents] == [2, 4]


@pytest.mark.parametrize("name", ["w", "phi"])
def test_no_control_of_that_name(hoop, name):
    with pytest.raises(HolonomError) as refused:
        hoop.branches(name, [1.0])
    assert refused.value.kind is ErrorKind.NOT_A_CONTROL
