"""Words of the glossary that the project no longer uses, in prose, identifiers and documents."""

import io
import re
import tokenize
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SUFFIXES = {".py", ".mac", ".lisp", ".md", ".toml", ".json", ".c", ".h", ".js", ".html"}
# Words of the glossary's left column that stay: "hard case", the order's own word and the name of a folder, a command's
# document and a table; "rate" in identifiers, where the glossary asks for prose only; "letter" for those of an alphabet
# or an index; "bar" for a part of a mechanism, a picture or a console; "miss" and "hold" in their plain meaning.
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
    r"(?<!turn.the.)(?<!paper/)knobs?": "control input",
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
    r"judge[sd]?|judging|candidates?": "verify, benchmark case",
    r"obstacles?": "obstruction",
    r"held|unheld|kept": "sliding, recorded, stored, satisfied",
    r"courses?": "reference trajectory",
    r"arcs?(?!.(?:co)?sines?|.tangents?|.of circles)": "collocation step",
    r"doubtful|unconfined|kept_at|held_up": "inaccurate, unsandboxed, place_of, rejected",
}
# Words that comments, docstrings, messages and descriptions of schemas no longer use; identifiers may.
REPLACED_IN_PROSE = {
    r"says?|said|tells?|told": "states, reports, returns, message",
    r"beside": "besides, with, relative to, in the folder of",
    r"at (?:the|a) start|of (?:the|a) start|from the start": "initial time, initial state",
    r"(?<!there )(?:is|are) no(?! longer| later| other)": "is not",
    r"stand(?:s|ing)? for": "is, means, replaces",
    r"(?:is|are|was|were|be|been) refused|refuses|refusing": "is an error, reject, not supported",
    r"sentences?": "message",
    r"kinks?": "corner",
    r"the print|(?:as|in) print|as printed(?!\.mac)": "the published version, as published",
    r"follow(?:s|ed|ing)? (?:the|a|this|its|each) motions?|motions? (?:is|are|was|were) followed": "integrate",
    r"pieces?": "part, polynomial, interval",
    r"(?<!Greek )(?<!index )letters?": "symbol, character",
    r"misses (?:the constraints|something)|miss of being|to miss zero": "violates the constraints by, has an error",
    r"(?<!switching )surfaces?": "switching surface",
    r"rates?": "time derivative, velocity, slope",
    r"keeps? (?:the|their|all|its)? ?(?:constraints?|digits?)": "satisfies the constraints, is correct to",
    r"hold to|holds? \w+ to": "make follow, compare",
}
# Files in which a word has another meaning, with the reason.
ALLOWED = {
    r"nobody|whoever": {"harness/sandbox.py": "the user nobody of Unix"},
    r"(?<!turn.the.)(?<!paper/)knobs?": {
        "tests/": "the file of the chapter with this title",
        "harness/companion/book/turn-the-knob.md": "its run, figure and form",
        "harness/companion/templates/knob.js": "its script",
    },
    r"go(?:es)? on|going on|went on": {
        "tests/test_sandbox.py": "text that a scene prints",
        "tests/test_maxima.py": "text that a scene prints",
    },
    r"lanes?": {"harness/program/": "SIMD lanes of a vector in C", "tests/program/": "the same"},
    r"judge[sd]?|judging|candidates?": {
        "harness/simulation/control_matrix.py": "candidates for zeros",
        "maxima/algebra/simplify.mac": "candidates for a form",
        "maxima/general/initial_state.mac": "candidates for roots",
    },
    r"beside": {"harness/cli/beside.py": "the module's name"},
    r"(?<!Greek )(?<!index )letters?": {
        "harness/description.py": "names of letters and digits",
        "harness/failures.py": "the same",
        "harness/program/identifiers.py": "the same",
        "harness/figures/style.py": "scripts of languages, Greek letters",
        "harness/typeset/": "Latin and Greek letters",
        "maxima/paper/": "letters of indices",
        "maxima/language/names.lisp": "the same",
        "maxima/refusals.mac": "the same",
        "maxima/record/description.lisp": "a variable",
    },
    r"pieces?": {
        "harness/program/c_source.py": "a name in generated C",
        "harness/program/targets/": "the same, and in MATLAB",
    },
    r"the print|(?:as|in) print|as printed(?!\.mac)": {
        "harness/display/derivation.py": "the heading beside the derived equation",
        "harness/companion/": "the misprints of the paper",
    },
    r"sentences?": {"harness/companion/": "a filter of templates"},
    r"rates?": {  # identifiers with "rate" stay, as the glossary has it
        "harness/simulation/": "decay rates, the rate of a stabilization",
        "harness/benchmark/work_precision/solvers.py": "a parameter of SciPy's form f(t, y)",
        "harness/stability/along.py": "a parameter",
        "harness/stability/linear_equations.py": "a name of rows in documents",
        "harness/display/progress.py": "motions per second",
        "harness/program/targets/c.py": "the same",
        "maxima/stability/linearization.mac": "the same",
        "harness/typeset/formula.py": "a head of equation trees",
        "maxima/paper/": "the same",
        "maxima/program/": "parameters",
        "maxima/algebra/": "a value under a key, the rate of change of a symbol",
    },
    r"(?<!switching )surfaces?": {"harness/companion/templates/": "surfaces in space"},
    r"at (?:the|a) start|of (?:the|a) start|from the start": {
        "harness/headless.lisp": "a place in a file",
        "harness/simulation/sensitivities.py": "the beginning of a part",
    },
}
# Chinese words for those of the glossary, in catalogs and README.zh.md.
REPLACED_IN_CHINESE = {
    "(?<!转动)旋钮": "控制参数",
    "瞬间": "时刻",
    "障碍": "奇异, 约束",
    "打击": "冲量",
    "孪生": "对应的页面",
    "怀疑": "精度检查",
    "治愈|疗法": "约束稳定化",
    "候选者|竞赛": "基准测试, 方法",
    "陌生人": "不受信任的",
}
SKIPPED = ("tests/benchmarks/", "tests/test_words.py")  # measurements


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


COMMENT = r"/\*.*?\*/"
STRING = r'"(?:\\.|[^"\\])*"'
PROSE = {  # by suffix: what is read by people in a file
    ".mac": re.compile(f"{COMMENT}|{STRING}", re.DOTALL),
    ".lisp": re.compile(rf";[^\n]*|{STRING}"),
    ".json": re.compile(rf'(?<="description": ){STRING}'),
    ".md": re.compile(r"(?<=\n)(?!    ).+"),
    ".toml": re.compile(rf"#[^\n]*|{STRING}"),
    ".js": re.compile(rf"{COMMENT}|//[^\n]*", re.DOTALL),
    ".c": re.compile(COMMENT, re.DOTALL),
    ".h": re.compile(COMMENT, re.DOTALL),
}


def prose(file):
    """Yield the line and the text of comments, docstrings and strings with blanks."""
    text = file.read_text(encoding="utf-8")
    if file.suffix == ".py":
        tokens = tokenize.generate_tokens(io.StringIO(text).readline)
        found = [
            (token.start[0], token.string) for token in tokens if token.type in (tokenize.COMMENT, tokenize.STRING)
        ]
    else:
        matches = PROSE[file.suffix].finditer(text)
        found = [(text.count("\n", 0, each.start()) + 1, each[0]) for each in matches]
    yield from ((line + k, each) for line, part in found if " " in part for k, each in enumerate(part.splitlines()))


@pytest.fixture(scope="module")
def proses():
    files = [
        each for name in ("harness", "maxima") for each in (ROOT / name).rglob("*") if each.suffix in {".py", *PROSE}
    ]
    files += [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "tests/README.md")]
    named = {each.relative_to(ROOT).as_posix(): each for each in files}
    return {name: list(prose(each)) for name, each in named.items()}


@pytest.mark.parametrize("word", REPLACED_IN_PROSE)
def test_an_old_word_is_in_no_prose(proses, word):
    pattern = re.compile(rf"(?<![A-Za-z`_])(?:{word})(?![A-Za-z_])", re.IGNORECASE)
    allowed = tuple(ALLOWED.get(word, ()))
    found = [
        f"{name}:{number}: {line.strip()}"
        for name, lines in proses.items()
        if not (allowed and name.startswith(allowed))
        for number, line in lines
        if pattern.search(line)
    ]
    assert found == [], f"the word is {REPLACED_IN_PROSE[word]}"


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


@pytest.mark.parametrize("word", REPLACED_IN_CHINESE)
def test_an_old_word_is_in_no_chinese_text(word):
    files = [ROOT / "README.zh.md", *(ROOT / "harness/locale/zh").rglob("*.po")]
    found = [line for file in files for line in file.read_text("utf-8").splitlines() if re.search(word, line)]
    assert found == [], f"the word is {REPLACED_IN_CHINESE[word]}"
