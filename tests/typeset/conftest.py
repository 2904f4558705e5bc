"""The paper as printed, compared once for all tests of its typesetting."""

import pytest

from holonom.errata import PrintedEquation, errata


@pytest.fixture(scope="session")
def printed_equations() -> tuple[PrintedEquation, ...]:
    return errata()
