"""Results of the examples agree with the check: some true ones did not, or ended in an internal error."""

import json
from pathlib import Path

import pytest

import holonom
from holonom.crosscheck.report import Verdict
from holonom.crosscheck.results import verify_result
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import Publication, published
from holonom.series.power_series import series_document

EXAMPLES = Path(__file__).parents[2] / "examples"
RESULTS = {
    "linearize": lambda scene: published(Publication.LINEARIZED, scene.linearize().document()),
    "linearize-along": lambda scene: published(
        Publication.LINEARIZED_ALONG, scene.linearize_along(until="1/10", samples=2).document()
    ),
    "equilibria": lambda scene: published(Publication.EQUILIBRIA, scene.equilibria(starts=20).document()),
    "series": lambda scene: series_document(scene.series(order=4)),
}
SCENES = (
    *("heavy_top", "prescribed_tension:steady_scene", "prescribed_tension:thrown_scene", "arm:circle_scene"),
    *("overhead_crane:line_scene", "hoist:recorded_scene", "pendulum:swing_scene", "crane", "bead", "satellite"),
    *("spherical_pendulum:shaken_scene", "whirling_bob", "level_load", "car_axis", "shaken_pendulum"),
)
WITHOUT = (
    ErrorKind.NOT_ANALYTIC,
    ErrorKind.NEVER_AT_REST,
    ErrorKind.REFUSED,
    ErrorKind.NOT_LINEARIZED,
    ErrorKind.NO_LAW,
)
QUICK = ("crane", "prescribed_tension:steady_scene", "arm:circle_scene", "hoist:recorded_scene")


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in QUICK else pytest.mark.long) for name in SCENES]
)
def test_results_of_an_example_agree(name):
    file, _, scene = name.partition(":")
    found = holonom.load(EXAMPLES / f"{file}.mac", scene=scene or None)
    made = 0
    for kind, make in RESULTS.items():
        try:
            content = json.loads(json.dumps(make(found)))
        except HolonomError as error:
            if error.kind in WITHOUT:
                continue
            raise
        verdict = verify_result(found.description, content)
        assert verdict.verdict in (Verdict.AGREES, Verdict.NOTHING), (kind, verdict.detail)
        made += verdict.verdict is Verdict.AGREES
    assert made
