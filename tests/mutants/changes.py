"""Small wrong changes of the body of one function, in Maxima, Lisp and Python.

`changes` maps each kind of change to the changes of that kind that a body allows. Python's operators are those of
Cosmic Ray, and four of ours beside them.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterator
from itertools import pairwise

Change = Callable[[], str]
Edit = tuple[str, int, int, str]  # kind, start, end, text
Span = tuple[int, int]


def _table(**kinds: str) -> dict[str, tuple[str, list[str]]]:
    """Return the kind and the replacements of each word: "a b c, d" has a replaced by b or c, and d left out."""
    rows = ((kind, row.split()) for kind, rows in kinds.items() for row in rows.split(","))
    return {old: (kind, new or [""]) for kind, (old, *new) in rows}


COMPARISON = "< <= >, > >= <, <= < >=, >= > <="
EXCHANGED = "some every, every some, first last, last first, second third, third second, min max, max min, "
EXCHANGED += "union intersection, intersection union, floor ceiling, ceiling floor"

MAXIMA = _table(
    comparison=f"{COMPARISON}, = #, # =",
    arithmetic="+ -, * /, / *, ^ *",
    boolean="and or, or and, true false, false true, not",
    exchange=f"{EXCHANGED}, cons endcons, endcons cons, lmin lmax, lmax lmin, lhs rhs, rhs lhs",
)
MAXIMA_TOKEN = re.compile(r"[A-Za-z_%?][\w%?]*|\d+(?:\.\d*)?(?:[ebd][+-]?\d+)?|:=|<=|>=|\S")
BEFORE_AN_OPERAND = {*"([,=#<>+-*/^:", *["<=", ">=", ":=", "and", "or", "not", "if", "then", "else", "do", "in"], ""}
NOT_CALLED = {"block", "lambda", "if", "then", "else", "elseif", "do", "and", "or", "not", "in", "while", "unless"}
COMMUTATIVE = {"max", "min", "gcd", "lcm"}

LISP = _table(
    comparison=f"{COMPARISON}, = /=, /= =",
    arithmetic="+ -, * /, 1+ 1-, 1- 1+, incf decf",
    boolean="and or, or and, not identity, null identity, when unless, unless when",
    exchange=f"{EXCHANGED}, car cadr, cons list, notany some, remove-if remove-if-not",
)
LISP_ANYWHERE = _table(boolean="t nil, nil t")
LISP_TOKEN = re.compile(r"(#?['`,]?@?)([()]|[^\s()'`,]+)")
LISP_BODIES = {"progn": 1, "when": 2, "unless": 2, "let": 2, "let*": 2, "dolist": 2, "dotimes": 2}


def changes(language: str, body: str, functions: frozenset[str] = frozenset()) -> dict[str, list[Change]]:
    """Return the changes of a body by kind; `functions` are the names that a call in Lisp may have."""
    if language == "py":
        return python_changes(body)
    edits = maxima_edits(body) if language == "mac" else lisp_edits(body, functions)
    found = defaultdict(list)
    for kind, start, end, text in edits:
        if body[start:end] != text:
            found[kind].append(lambda start=start, end=end, text=text: body[:start] + text + body[end:])
    return found


def blanked(language: str, source: str) -> str:
    """Return a source of the same length, its comments as spaces, its strings and characters as underscores."""
    comment, character = (r"/\*.*?\*/", "") if language == "mac" else (r";[^\n]*|#\|.*?\|#", r"|#\\(?:[^\s()]+|.)")
    pattern = re.compile(rf'({comment})|"(?:\\.|[^"\\])*"{character}', re.DOTALL)
    return pattern.sub(lambda found: re.sub(r"[^\n]", " " if found[1] else "_", found[0]), source)


def number_edits(start: int, text: str) -> Iterator[Edit]:
    for new in (int(text) + 1, int(text) - 1):
        if new >= 0:
            yield "constant", start, start + len(text), str(new)


def swapped_edits(body: str, arguments: list[Span]) -> Iterator[Edit]:
    for (a, b), (c, d) in pairwise(arguments):
        yield "arguments", a, d, body[c:d] + body[b:c] + body[a:b]


def maxima_edits(body: str) -> Iterator[Edit]:
    """Edits of a Maxima expression, token by token and bracket by bracket."""
    tokens = [(found.start(), found[0]) for found in MAXIMA_TOKEN.finditer(blanked("mac", body))]
    before = ""
    for place, (start, text) in enumerate(tokens):
        kind, texts = MAXIMA.get(text, ("", ()))
        if text == "-":
            kind, texts = ("sign", ("",)) if before in BEFORE_AN_OPERAND else ("arithmetic", ("+",))
        yield from ((kind, start, start + len(text), new) for new in texts)
        if text.isdigit():
            yield from number_edits(start, text)
        if text in ("if", "elseif"):
            stop = _closing_then(tokens, place)
            yield from (("condition", start + len(text), stop, f" {value} ") for value in ("true", "false"))
        if text == "(":
            yield from _maxima_list_edits(body, before, _parts(tokens, place))
        before = text


def _closing_then(tokens: list[tuple[int, str]], place: int) -> int:
    depth = 0
    for start, text in tokens[place + 1 :]:
        depth += (text == "if") - (text == "then")
        if depth < 0:
            return start
    raise ValueError("an if without then")


def _parts(tokens: list[tuple[int, str]], place: int) -> list[Span]:
    """Return the spans between the commas of the bracket that opens at a place."""
    depth, spans, begun, end = 0, [], None, 0
    for start, text in tokens[place:]:
        depth -= text in ")]"
        if begun is not None and (depth == 0 or (depth == 1 and text == ",")):
            spans.append((begun, end))
            begun = None
        elif begun is None and depth == 1 and text not in ")]":
            begun = start
        if depth == 0 and text in ")]":
            break
        depth += text in "(["
        end = start + len(text)
    return spans


def _maxima_list_edits(body: str, before: str, parts: list[Span]) -> Iterator[Edit]:
    if re.match(r"[\w%?]", before) and before not in NOT_CALLED:
        if before not in COMMUTATIVE:
            yield from swapped_edits(body, parts)
    elif before != "lambda":
        for (start, _), (following, _) in pairwise(parts):
            if body[start] != "[":
                yield "statement", start, following, ""


def lisp_edits(body: str, functions: frozenset[str]) -> Iterator[Edit]:
    """Edits of Lisp forms: first those of atoms, then those of lists."""
    hidden = re.sub(r"\(declare\b.*", lambda found: " " * len(found[0]), blanked("lisp", body))
    tokens = [*LISP_TOKEN.finditer(hidden)]
    for token in tokens:
        is_head = token[1] == "#'" or hidden[: token.start()].endswith("(")
        kind, texts = LISP_ANYWHERE.get(token[2]) or (LISP if is_head else {}).get(token[2], ("", ()))
        yield from ((kind, *token.span(2), new) for new in texts)
        if token[2].isdigit():
            yield from number_edits(token.start(2), token[2])
    opened: list[tuple[int, list[Span]]] = [(0, [])]
    for token in tokens:
        start, end = token.span()
        if token[2] == "(":
            opened.append((start, []))
            continue
        if token[2] == ")":
            start, parts = opened.pop()
            yield from _lisp_list_edits(body, hidden, parts, functions)
        opened[-1][1].append((start, end))
    yield from _dropped(opened[0][1], 0)


def _lisp_list_edits(body: str, hidden: str, parts: list[Span], functions: frozenset[str]) -> Iterator[Edit]:
    if not parts:
        return
    head = hidden[slice(*parts[0])]
    if head in ("if", "when", "unless"):
        yield from (("condition", *parts[1], value) for value in ("t", "nil"))
    if head == "-" and len(parts) == 2:
        yield "sign", *parts[0], "identity"
    elif head == "-":
        yield "arithmetic", *parts[0], "+"
    if head in LISP_BODIES:
        yield from _dropped(parts, LISP_BODIES[head])
    elif head in functions:
        yield from swapped_edits(body, parts[1:])


def _dropped(parts: list[Span], first: int) -> Iterator[Edit]:
    return (("statement", *part, "nil") for part in parts[first:-1])


def python_changes(body: str) -> dict[str, list[Change]]:
    """Changes of a Python function's body by Cosmic Ray's operators and ours."""
    from cosmic_ray.ast import ast_nodes, get_ast
    from cosmic_ray.mutating import mutate_code
    from python_operators import operators

    source = f"def _():\n{body}"
    nodes = list(ast_nodes(get_ast(source)))
    found = defaultdict(list)
    for kind, operator in operators():
        for i in range(sum(1 for node in nodes for _ in operator.mutation_positions(node))):
            found[kind].append(lambda operator=operator, i=i: mutate_code(source, operator, i).partition("\n")[2])
    return found
