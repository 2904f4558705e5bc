"""Records of the examples, each derived once."""

from pathlib import Path

import pytest

from holonom.record import Record, derived_record

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@pytest.fixture(
    scope="session",
    params=["paper/paper.mac", "weightless_cabin.mac", "pendulum.mac", "bead.mac"],
)
def example_record(request: pytest.FixtureRequest) -> Record:
    return derived_record(EXAMPLES / request.param)


@pytest.fixture(scope="session")
def paper_record() -> Record:
    return derived_record(EXAMPLES / "paper" / "paper.mac")
