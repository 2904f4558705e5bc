"""Maxima's own tests: every rtest file passes, to the last pair that it holds."""

from pathlib import Path

import pytest
from rtests import RtestFailed, run_rtest

from holonom.failures import HolonomError

RTESTS = sorted(Path(__file__).with_name("maxima").glob("rtest_*.mac"))


@pytest.mark.parametrize("rtest", RTESTS, ids=lambda file: file.stem)
def test_rtest(rtest: Path, record_property) -> None:
    try:
        tests = run_rtest(rtest)
    except HolonomError as error:
        pytest.fail("\n".join([str(error), *error.last_lines]), pytrace=False)
    except RtestFailed as error:
        pytest.fail(str(error), pytrace=False)
    record_property("maxima_tests", tests)
    assert tests > 0
