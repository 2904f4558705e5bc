"""Messages are English until a catalog translates them, with the numbers that stand in them."""

import pickle
from gettext import NullTranslations

import pytest

from holonom import language
from holonom.language import gettext, ngettext, speaking, translatable, translated


class Shouting(NullTranslations):
    def gettext(self, message):
        return message.upper().replace("%(COUNT)S", "%(count)s").replace("%(WHY)S", "%(why)s")


@pytest.fixture
def shouting(monkeypatch):
    known = language._catalog
    monkeypatch.setattr(language, "_catalog", lambda name: Shouting() if name == "zh" else known(name))


def test_a_message_is_translated_inside_the_block_and_nowhere_else(shouting):
    with speaking("zh"):
        assert gettext("free motion") == "FREE MOTION"
    assert gettext("free motion") == "free motion"


def test_a_result_that_was_made_in_english_is_translated_with_all_that_stands_in_it(shouting):
    reason = translatable("%(count)s are dependent: %(why)s", count=2, why=translatable("the rods are parallel"))
    assert reason == "2 are dependent: the rods are parallel"
    with speaking("zh"):
        assert translated(reason) == "2 ARE DEPENDENT: THE RODS ARE PARALLEL"
        assert translated(pickle.loads(pickle.dumps(reason))) == translated(reason)


def test_a_per_cent_sign_of_a_message_without_values_stays_as_it_is():
    assert translatable("100 % of it") == "100 % of it"
    assert gettext("100 % of it") == "100 % of it"


def test_nothing_is_translated_to_nothing():
    with speaking("zh"):
        assert gettext("") == ""


def test_english_counts_one_and_several():
    assert ngettext("%(n)s step", "%(n)s steps", 1, n=1) == "1 step"
    assert ngettext("%(n)s step", "%(n)s steps", 2, n=2) == "2 steps"
