"""Words of the glossary that the project no longer uses, in prose, identifiers and documents."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SUFFIXES = {".py", ".mac", ".lisp", ".md", ".toml", ".json", ".c", ".h", ".js", ".html"}
# Old word: the word in its place. A word is also found inside an identifier, such as last_time.
REPLACED = {
    r"instants?": "time, time_point",
    r"(?:followed|motion|search) in numbers": "numerically",
    r"confined": "sandboxed",
    r"strangers?(?:'s)?|somebody else's": "untrusted, unrelated",
    r"drift_cures|cures?": "stabilization",
    r"remarks?": "note",
    r"remed(?:y|ies)": "hint",
    r"passages?": "event outcome",
    r"doubts?|distrust": "accuracy violation",
    r"lanes?": "batch element",
    r"torn": "truncated",
    r"sheets_of": "page_numbers",
    r"plain_motion|plain way": "baseline",
    r"followable": "parametrized problem",
    r"blows?": "impulse",
    r"way on": "continuation",
    r"hand on|hand_on": "yield, flush",
    r"meanwhile": "in the background",
    r"contest": "benchmark",
    r"front door|the house": "public API, project layout",
    r"so many": "the number itself",
    r"nobody|whoever": "passive voice, a noun",
    r"it_pays": "worthwhile",
    r"claims?|judgements?": "derived expression, compared value, result",
    r"twins?": "partner, private symbol, translated page",
    r"knobs?": "control input",
    r"(?:un)?walled": "sandboxed",
    r"digits[ _]kept": "correct digits",
    r"in_numbers": "numeric, with values",
    r"law_of_controls": "control law",
    r"for instance": "for example",
    r"hangs? on": "depends on",
    r"go(?:es)? on|going on|went on": "continue",
    r"in the place of": "in place of",
    r"paper's numbers?": "equation number",
    r"pass(?:es|ed)? over|stepp?(?:s|ed)? over": "miss, skip",
    r"told_apart|_said|said_|_told": "distinguished, reported",
    r"stretch(?:es)?": "sample block",
    r"by hand of|as far as known|none but": "plain words",
}
# Files in which a word has another meaning, with the reason.
ALLOWED = {
    r"nobody|whoever": {"harness/sandbox.py": "the user nobody of Unix"},
    r"knobs?": {"tests/": "the file of the chapter with this title"},
    r"go(?:es)? on|going on|went on": {
        "tests/test_sandbox.py": "text that a scene prints",
        "tests/test_maxima.py": "text that a scene prints",
    },
    r"lanes?": {"harness/program/": "SIMD lanes of a vector in C", "tests/program/": "the same"},
}
SKIPPED = (
    "harness/companion/",
    "tests/companion/",
    "tests/benchmarks/",
    "tests/test_words.py",
)  # the book; measurements


def separated(text):
    """The text with the words of identifiers such as EngineSegment separated."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", text)


@pytest.fixture(scope="module")
def sources():
    folders = ("harness", "maxima", "tests", "examples")
    files = [file for folder in folders for file in (ROOT / folder).rglob("*") if file.suffix in SUFFIXES]
    files += [ROOT / name for name in ("README.md", "CONTRIBUTING.md")]
    named = {file.relative_to(ROOT).as_posix(): file for file in files}
    return {
        name: separated(file.read_text(encoding="utf-8")).splitlines()
        for name, file in named.items()
        if not name.startswith(SKIPPED)
    }


@pytest.mark.parametrize("word", REPLACED)
def test_an_old_word_is_used_nowhere(sources, word):
    pattern = re.compile(rf"(?<![A-Za-z])(?:{word})(?![A-Za-z])", re.IGNORECASE)
    allowed = tuple(ALLOWED.get(word, ()))
    found = [
        f"{name}:{number}: {line.strip()}"
        for name, lines in sources.items()
        if not (allowed and name.startswith(allowed))
        for number, line in enumerate(lines, 1)
        if pattern.search(line)
    ]
    assert found == [], f"the word is {REPLACED[word]}"
