"""A sign turned in a derivation file: the verdict turns with it."""

import shutil

import pytest
from pages import REPOSITORY

from holonom import maxima
from holonom.companion.cards import cards_for
from holonom.companion.chapter import chapters_of_the_paper

RIGHT = '"2 d^2f/dq_s du_r dot(q_s) dot(u_r)" = 2*mixed_form(f,'
WRONG = RIGHT.replace("= 2*", "= -2*")
SHOWN = ("bob_file", "paper")  # the derivations that cards are made of


@pytest.fixture(scope="module")
def cards(results, tmp_path_factory):
    """Those of the chapter, its derivations made with the slip."""
    root = tmp_path_factory.mktemp("slip")
    for folder in ("maxima", "examples"):
        shutil.copytree(REPOSITORY / folder, root / folder)
    file = root / "maxima" / "derivation" / "constraint_acceleration.mac"
    text = file.read_text()
    assert RIGHT in text
    file.write_text(text.replace(RIGHT, WRONG))
    chapter = chapters_of_the_paper()["equations-of-motion"]
    found = {name: results[run] for name, run in chapter.runs.items()}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(maxima, "LIBRARY", root / "maxima")
        patch.setattr(maxima, "preloaded_image", lambda *_: None)  # an image for two runs would take longer than they
        for name in SHOWN:
            run = chapter.runs[name]
            file, *others = run.arguments
            found[name] = run.compute(root / file.relative_to(REPOSITORY), *others)
    numbers = ("2", "3a", "3", "4", "5", "6", "7", "8", "9")
    return cards_for(numbers, [found["bob_file"], found["paper"]], found["printed"])


def verdicts(card):
    return {found.verdict for each in card.instances for found in each.verdicts}


@pytest.mark.parametrize("anchor", ["eq-7", "eq-8", "eq-8-multipliers", "eq-9"])
def test_the_equation_and_what_follows_from_it_disagree(cards, anchor):
    assert "disagrees" in verdicts(cards[anchor])


@pytest.mark.parametrize("anchor", ["eq-2", "eq-3a", "eq-3", "eq-4", "eq-5", "eq-6"])
def test_what_does_not_depend_on_it_stands(cards, anchor):
    assert "disagrees" not in verdicts(cards[anchor])
