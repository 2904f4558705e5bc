"""The figures' style: the same bytes from the same numbers, text as text, the reader's ink, whole or not at all."""

from xml.etree import ElementTree

import matplotlib
import pytest
from refusing import failing

from holonom.failures import ErrorKind
from holonom.figures.style import INK, PALETTE, figure_style, new_figure, with_symbols, write_figure

SVG = "{http://www.w3.org/2000/svg}"


def drawn(path):
    with figure_style():
        figure = new_figure(4, 3)
        axes = figure.subplots()
        for power in range(len(PALETTE)):
            axes.plot([0, 1, 2], [0, 1, 2**power], label=f"power {power}")
        axes.set(xlabel="u₀", title="Powers & <more>")
        axes.legend()
    write_figure(figure, path)
    return path.read_text()


def test_same_numbers_same_bytes(tmp_path):
    assert drawn(tmp_path / "one.svg") == drawn(tmp_path / "other.svg")


def test_text_is_text(tmp_path):
    root = ElementTree.fromstring(drawn(tmp_path / "figure.svg"))
    texts = {"".join(element.itertext()) for element in root.iter(f"{SVG}text")}
    assert {"u₀", "Powers & <more>", "power 0"} <= texts


def test_ink_is_the_reader_s_own_and_nothing_lies_behind(tmp_path):
    root = ElementTree.fromstring(drawn(tmp_path / "figure.svg"))
    rule = "".join(root.find(f"{SVG}style").itertext())
    assert "prefers-color-scheme:dark" in rule
    styles = [element.get("style", "") for element in root.iter()]
    assert not any(INK in style for style in styles)
    assert any("currentColor" in style for style in styles)
    assert not any("fill: #ffffff" in style for style in styles)


def test_settings_of_matplotlib_are_left_as_they_were(tmp_path):
    before = dict(matplotlib.rcParams)
    drawn(tmp_path / "figure.svg")
    assert dict(matplotlib.rcParams) == before


def test_what_cannot_be_written_is_refused(tmp_path):
    with failing(ErrorKind.UNWRITABLE):
        drawn(tmp_path / "nowhere" / "figure.svg")


@pytest.mark.parametrize(
    ("name", "letters"),
    [("lambda1", "λ₁"), ("q12", "q₁₂"), ("dot(phi)", "φ̇"), ("Lambda", "Λ"), ("x", "x"), ("slider", "slider")],
)
def test_quantities_are_named_by_their_letters(name, letters):
    assert with_symbols(name) == letters
