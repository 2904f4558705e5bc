"""Numbers of equations in prose are links; others in brackets are not."""

import pytest

from holonom.companion.finish import with_equations

LINK = '<a class="equation" href="there.html#eq-8">(8)</a>'


@pytest.mark.parametrize(
    ("text", "linked"),
    [
        ("<p>By (8) it follows</p>", f"<p>By {LINK} it follows</p>"),
        ("<p>由式(8)得</p>", f"<p>由式{LINK}得</p>"),
        ("<p>by (9), which has no place</p>", None),
        ("<p>Mekhanika 28(8), 15</p>", None),
        ("<p>holonom(8)</p>", None),
        ("<p><code>f (8)</code></p>", None),
    ],
)
def test_a_number_of_an_equation_is_a_link_in_prose(text, linked):
    assert with_equations(text, {"8": "there.html#eq-8"}) == (linked or text)
