"""Maxima's help has every entry, at the place where the index says."""

import re
from itertools import pairwise

import pytest

from holonom.reference.entries import function_texts, part_texts, step_texts, tool_texts
from holonom.reference.maxima_help import help_files

FILES = help_files()
PLACE = re.compile(r'\("([^"]+)" \. \("holonom\.info" (\d+) (\d+) "')
TOPICS = {name: (int(start), int(length)) for name, start, length in PLACE.findall(FILES["holonom-index.lisp"])}
ENTRIES = [entry for function in function_texts() for entry in function.entries]


def explained(topic: str) -> str:
    """What Maxima reads: a number of characters from that byte on, in one line."""
    start, length = TOPICS[topic]
    return " ".join(FILES["holonom.info"].encode()[start:][:length].decode().split())


def test_a_byte_is_a_character_as_maxima_counts():
    assert all(text.isascii() for text in FILES.values())


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: f"{entry.function}-{entry.name}")
def test_every_entry_is_a_topic_with_its_whole_text(entry):
    found = [explained(topic) for topic in TOPICS if topic.partition(" ")[0] == entry.name]
    [text] = [text for text in found if text.startswith(f"-- Entry of {entry.function}: {entry.name} ")]
    message = (entry.text, entry.type, entry.default, entry.example, *(error.message for error in entry.errors))
    assert all(" ".join(each.split()) in text for each in message)


@pytest.mark.parametrize("part", [*part_texts(), *step_texts(), *tool_texts()], ids=lambda part: part.name)
def test_every_function_called_by_itself_is_a_topic_with_its_whole_text(part):
    message = (part.call, part.text, part.example, part.gives, *(error.message for error in part.errors))
    [text] = [found for topic in TOPICS if f"-- Function: {part.call} " in (found := explained(topic))]
    assert all(" ".join(each.split()) in text for each in message)


def test_topics_follow_one_another_without_overlap():
    places = sorted(TOPICS.values())
    functions = (*function_texts(), *part_texts(), *step_texts(), *tool_texts())
    assert len(places) == len(ENTRIES) + len(functions)
    assert all(start + length < following for (start, length), (following, _) in pairwise(places))


@pytest.mark.parametrize("function", function_texts(), ids=lambda function: function.name)
def test_both_functions_have_a_topic_and_an_example(function):
    assert function.summary in explained(function.name)
    assert f"\n&& {function.name}\n" in FILES["examples.demo"]
