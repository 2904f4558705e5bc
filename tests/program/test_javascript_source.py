"""A program in JavaScript, run by Node, gives the same numbers as one carried out with fifty digits."""

import json
import shutil
import subprocess

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from programs import (
    ENDS,
    ENDS_POINTS,
    ENDS_VALUES,
    PENDULUM,
    assume_well_conditioned,
    chain,
    program,
    random_points,
    random_programs,
)
from reference import assert_within_bounds, reference

from holonom.failures import ErrorKind, HolonomError
from holonom.program.targets import javascript

RUN = "\nconsole.log(JSON.stringify(JSON.parse(require('fs').readFileSync(0)).map(motion.evaluate)));"
NODE = shutil.which("node")
by_node = pytest.mark.skipif(NODE is None, reason="no JavaScript was run: node is not installed")


def run(written, points):
    """Outputs of the program at each point, by Node; shape (points, outputs)."""
    script = javascript.write(written) + RUN
    done = subprocess.run(
        [NODE, "-e", script], input=json.dumps(points.T.tolist()), capture_output=True, text=True, check=True
    )
    return np.array(json.loads(done.stdout), dtype=float)


def assert_same_numbers(written):
    points = random_points(written)
    for point, outputs in zip(points.T, run(written, points), strict=True):
        assert_within_bounds("JavaScript", reference(written, point.tolist()), outputs)


@by_node
@pytest.mark.parametrize("written", [PENDULUM, chain(12)], ids=["pendulum", "chain"])
def test_programs_by_hand(written):
    assert_same_numbers(written)


@by_node
@settings(max_examples=10, suppress_health_check=list(HealthCheck))
@given(random_programs())
def test_random_programs(written):
    assume_well_conditioned(written)
    assert_same_numbers(written)


@by_node
def test_there_is_no_value_where_functions_of_the_time_have_ended():
    assert run(ENDS, ENDS_POINTS).ravel().tolist() == ENDS_VALUES


@by_node
def test_names_and_titles_cannot_end_what_they_stand_in():
    written = program(['a"; */ throw 1; /*'], [("w", ["Negate", 'a"; */ throw 1; /*'])], {"</script>": "w"})
    assert run(written, np.array([[2.0]])) == [[-2.0]]
    assert "</script>" not in javascript.write(written)


def test_what_cannot_name_a_constant_is_refused():
    with pytest.raises(HolonomError) as caught:
        javascript.write(PENDULUM, "my motion")
    assert caught.value.kind is ErrorKind.NOT_AN_IDENTIFIER
