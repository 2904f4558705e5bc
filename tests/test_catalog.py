"""The catalogs hold the messages of the sources, and what is wrong in a translation is found."""

import re
from pathlib import Path

import pytest
from babel.messages.catalog import Catalog
from catalog import STRING, TEMPLATE, collected, faults, read_catalog, template_text

from holonom.language import ENGLISH, LANGUAGES
from holonom.maxima import LIBRARY

SENTENCE = re.compile(r"[A-Za-z]{2,} [a-z]{2,} [a-z]{2,}")
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
        ("%(n)s steps", "%(m)s 步", "%(m)s, %(n)s differ"),
        ("at <em>every</em> state", "每一状态", "</em>, <em> differ"),
        ("the law $u = t$", "规律 $u=t$", "$u = t$, $u=t$ differ"),
        ("see `holonom free`", "见 holonom free", "`holonom free` differ"),
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


def test_every_reason_of_a_free_motion_is_a_message(found):
    """A reason that is put together with sconcat is English on a Chinese page."""
    messages = {message.id for message in found}
    sentences = {}
    for file in [each for name in ("algebra", "free_motion") for each in sorted((Path(LIBRARY) / name).glob("*.mac"))]:
        text = re.sub(r"/\*.*?\*/|define_variable\([^$]*\$", "", file.read_text(encoding="utf-8"), flags=re.DOTALL)
        for each in re.findall(STRING, text):
            sentence = " ".join(each.replace("\\\n", "").split())
            if SENTENCE.search(sentence) and sentence not in messages:
                sentences[sentence] = file.name
    assert sentences == {}
