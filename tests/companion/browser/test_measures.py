"""The measures see what they are for: each fault, planted on a sound page, is found, and no other."""

import pytest
from observation import observe
from views import DESK, VIEWS

pytestmark = pytest.mark.browser

PAGE = """<!DOCTYPE html>
<html xmlns="http://www.w3.org/1999/xhtml" lang="en">
<head><meta charset="utf-8" /><title>A page</title><link rel="icon" href="data:," />
<meta name="viewport" content="width=device-width, initial-scale=1" /></head>
<body style="color: black; background: white"><h1>A page</h1>
<p>with <math><msup><mi>q</mi><mn>2</mn></msup></math></p>
<svg width="20" height="20" role="img" aria-label="a disc"><circle cx="10" cy="10" r="9"></circle></svg>
<div tabindex="0" style="overflow-x: auto"><div style="width: 3000px">far</div></div>
<details><summary>more</summary>{fault}</details>
</body></html>"""
FAULTS = {
    "messages": "<script>console.error('no')</script>",
    "wider": '<div style="width: 3000px">far</div>',
    "cut_off": '<div style="height: 1em; overflow: hidden">one<br />two<br />three</div>',
    "out_of_reach": '<div inert="inert" style="overflow-x: auto"><div style="width: 3000px">far</div></div>',
    "idle_stops": '<div tabindex="0">nothing to scroll</div>',
    "off_screen": '<div class="formula" style="overflow-x: auto"><div style="width: 3000px">far</div></div>',
    "towering": '<div class="formula"><div style="height: 700px">high</div></div>',
    "flat_mathematics": '<math style="display: none"><mi>q</mi></math>',
    "broken_mathematics": "<math><merror><mtext>no</mtext></merror></math>",
    "empty_pictures": '<img alt="none" width="9" height="9" src="data:image/svg+xml,none" />',
    "pale": '<p style="color: #808080">grey</p>',
    "nameless": '<a href="page.html"><span aria-hidden="true">on</span></a>',
}


@pytest.fixture(params=VIEWS, ids=str)
def faults_of(request, browser, tmp_path):
    def observed(fault: str) -> set[str]:
        page = tmp_path / "page.html"
        page.write_text(PAGE.format(fault=fault))
        found = observe(browser, page, request.param)
        return {kind for kind in FAULTS if getattr(found, kind)}

    return observed


def test_a_sound_page_has_no_faults(faults_of):
    assert faults_of("") == set()


@pytest.mark.parametrize("kind", FAULTS)
def test_a_planted_fault_is_found(faults_of, kind):
    assert faults_of(FAULTS[kind]) == {kind}


def test_what_is_loaded_from_elsewhere_is_noticed(browser, tmp_path):
    page = tmp_path / "page.html"
    page.write_text(PAGE.format(fault='<img alt="far" width="9" height="9" src="http://nowhere.invalid/far.png" />'))
    assert "http://nowhere.invalid/far.png" in observe(browser, page, DESK).requests
