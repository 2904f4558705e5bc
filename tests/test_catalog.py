"""The catalogs hold the messages of the sources, and what is wrong in a translation is found."""

import pytest
from babel.messages.catalog import Catalog
from catalog import TEMPLATE, collected, faults, read_catalog, template_text

from holonom.language import ENGLISH, LANGUAGES

OTHERS = [language for language in LANGUAGES if language != ENGLISH]


@pytest.fixture(scope="module")
def found():
    return collected()


def test_the_template_is_what_is_collected_from_the_sources(found):
    assert template_text(found) == TEMPLATE.read_text()


@pytest.mark.parametrize("language", OTHERS)
def test_a_catalog_has_the_messages_of_the_sources_and_no_others(found, language):
    assert {message.id for message in read_catalog(language)} == {message.id for message in found}


@pytest.mark.parametrize("language", OTHERS)
def test_every_message_is_translated_with_its_placeholders_marks_and_formulas(language):
    assert faults(read_catalog(language)) == []


@pytest.mark.parametrize(
    ("message", "translation", "fault"),
    [
        ("free motion", "", "no translation"),
        ("%(n)s steps", "%(m)s 步", "placeholders differ, %(m)s, %(n)s"),
        ("at <em>every</em> state", "每一状态", "marks differ, </em>, <em>"),
        ("the law $u = t$", "规律 $u=t$", "formulas differ, $u = t$, $u=t$"),
        ("see `holonom free`", "见 holonom free", "code differ, `holonom free`"),
    ],
)
def test_a_fault_of_a_translation_is_found(message, translation, fault):
    catalog = Catalog(locale="zh")
    catalog.add(message, translation)
    assert faults(catalog) == [f"{fault}: {message}"]


def test_a_fuzzy_translation_is_found_and_a_good_one_is_none():
    catalog = Catalog(locale="zh")
    catalog.add("free motion", "自由运动", flags=["fuzzy"])
    catalog.add(("%(n)s step", "%(n)s steps"), ("%(n)s 步",))
    assert faults(catalog) == ["fuzzy: free motion"]
