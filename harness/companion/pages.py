"""Pages from templates: XHTML that a browser reads as HTML, and that parses as XML."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any
from xml.etree import ElementTree

import jinja2
from markupsafe import Markup, escape
from sympy import Expr

from ..explanations import advice, engine_text, remarks
from ..free_motion import UniversalLaw
from ..language import ENGLISH, LANGUAGES, gettext, ngettext, spoken, translated
from ..number_texts import number
from ..record import Scene
from ..reference.topic import Topic
from . import TEMPLATES, mathematics
from .chapter import Chapter
from .excerpts import Excerpt
from .finish import Place
from .finish import terms as terms_in

LONGEST_COEFFICIENT = 12  # characters of an exact number in a table
NAMED_BY_MAXIMA = re.compile(r"(no control law makes every motion free: .* is )(.+)($)")
CODE_IN_TEXT = re.compile(r"`([^`]+)`")
NEGLIGIBLE = 1e-9  # of a complex number: a part of it that is rounding alone
STYLE = TEMPLATES / "companion.css"
WHITESPACE = {"trim_blocks": True, "lstrip_blocks": True, "keep_trailing_newline": True}


@dataclass(frozen=True)
class Entry:
    """A chapter's line in the contents."""

    label: str  # its number, or the letter of an appendix
    slug: str
    title: str
    aim: str


@dataclass(frozen=True)
class Part:
    """Chapters under one heading of the contents; without a title where there is one part only."""

    title: str
    entries: tuple[Entry, ...]


@dataclass(frozen=True)
class Twin:
    """The same book in another language: page by page the same names of files, in another directory."""

    language: str
    directory: str  # from this book's own, with a slash at its end

    @property
    def name(self) -> str:
        """What the language calls itself."""
        return LANGUAGES[self.language]


@dataclass(frozen=True)
class Contents:
    """What every page knows about the book."""

    title: str
    subtitle: str
    foreword: str  # template of what the first page says before the contents
    command: str  # the command that makes the book
    maxima: str  # version of Maxima that derived it
    parts: tuple[Part, ...]
    sessions: frozenset[str] = frozenset()  # slugs of the chapters that have a session of Maxima
    language: str = ENGLISH  # that it is written in
    twins: tuple["Twin", ...] = ()  # the same book in other languages

    @property
    def entries(self) -> list[Entry]:
        """All chapters in their order."""
        return [entry for part in self.parts for entry in part.entries]


def index_page(book: Contents, terms: Sequence[Place]) -> str:
    """Return the first page: foreword, contents, and where each word is defined."""
    return _rendered("index.html", "index.html", book=book, terms=terms)


def chapter_page(book: Contents, chapter: Chapter, content: Mapping[str, Any]) -> str:
    """Return the page of a chapter, well-formed.

    Raises
    ------
    jinja2.TemplateError
        The template wants what it is not given.
    xml.etree.ElementTree.ParseError
        The template makes a page that is not well-formed.
    """
    entries = book.entries
    place = next(place for place, entry in enumerate(entries) if entry.slug == chapter.slug)
    about = {
        "slug": chapter.slug,
        "title": entries[place].title,
        "label": _spelled_label(entries[place].label),
        "previous": entries[place - 1] if place else None,
        "next": entries[place + 1] if place + 1 < len(entries) else None,
    }
    return _rendered(chapter.template, f"{chapter.slug}.html", book=book, chapter=about, **content)


def printed_page(
    book: Contents, front: Markup, chapters: Sequence[tuple[Entry, Markup]], sheets: Mapping[str, int]
) -> str:
    """Return the whole book as one page, with the sheet that each place is on as far as it is known."""
    terms = terms_in({f"{entry.slug}.html": text for entry, text in chapters})
    return _rendered("print.html", "print.html", book=book, front=front, chapters=chapters, sheets=sheets, terms=terms)


def source_page(book: Contents, file: str, text: str) -> str:
    """Return a Maxima file with numbered lines."""
    return _rendered("source.html", source_name(file), book=book, file=file, lines=text.splitlines())


def topic_page(book: Contents, topic: Topic) -> str:
    """Return a page of the reference."""
    return _rendered("topic.html", topic_name(topic), book=book, topic=topic)


def source_name(file: str) -> str:
    """Name of the page of a Maxima file."""
    return f"source/{file.replace('/', '-')}.html"


def topic_name(topic: Topic) -> str:
    """Name of the page of a topic of the reference."""
    return f"reference/{topic.slug}.html"


def source_link(excerpt: Excerpt) -> str:
    """Link to the first line of an excerpt."""
    return f"{source_name(excerpt.file)}#L{excerpt.first_line}"


def _rendered(template: str, file_name: str, /, **content: Any) -> str:
    page = _environment(spoken()).get_template(template).render(file_name=file_name, **content)
    ElementTree.fromstring(page)
    return page


@cache
def _environment(language: str) -> jinja2.Environment:  # templates are compiled, and their words made, once a language
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        extensions=["jinja2.ext.i18n"],
        **WHITESPACE,
    )
    environment.install_gettext_callables(gettext, ngettext)
    environment.filters |= {
        "prose": mathematics.prose,
        "typeset": mathematics.typeset,
        "nothing_to_show": mathematics.nothing_to_show,
        "as_printed": mathematics.as_printed,
        "as_corrected": mathematics.as_corrected,
        "expression": mathematics.expression,
        "source_link": source_link,
        "source_page_link": source_name,
        "difference": mathematics.difference,
        "sentence": _sentence,
        "rounded": _rounded,
        "power_of_ten": _power_of_ten,
        "with_code": _with_code,
        "counted": _counted,
        "translated": translated,
        "continued": _continued,
        "equalities": _equalities,
        "each_equality": _each_equality,
        "numbers_of": _numbers_of,
        "symbols": _symbols,
        "emphasized": _emphasized,
        "both": _both,
        "law_text": _law_text,
        "signed": _signed,
        "advice": advice,
        "engine_text": engine_text,
        "remarks": remarks,
        "complex_numbers": _complex_numbers,
        "coefficient": _coefficient,
        "symbol": mathematics.symbol,
        "maxima_text": _maxima_text,
    }
    environment.globals |= {
        "tex": mathematics.tex,
        "equality": mathematics.equality,
        "display": mathematics.display,
        "display_named": mathematics.display_named,
        "display_expression": mathematics.display_expression,
    }
    return environment


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]


def _continued(text: str) -> str:
    return text[:1].lower() + text[1:]


def _listed(items: Iterable[Markup]) -> Markup:
    return Markup(gettext(", ")).join(items)


def _both(items: Iterable[Markup]) -> Markup:
    """Return two things, or more of them, joined by the word for and."""
    return Markup(gettext(" and ")).join(items)


def _each_equality(values: Mapping[str, Expr]) -> list[Markup]:
    return [mathematics.equality(name, value) for name, value in values.items()]


def _equalities(values: Mapping[str, Expr]) -> Markup:
    return _listed(_each_equality(values))


def _numbers_of(scene: Scene) -> dict[str, Expr]:
    """Parameters and initial state of a scene."""
    return {**scene.parameter_values, **scene.initial_state}


def _symbols(names: Iterable[str]) -> Markup:
    return _listed(map(mathematics.symbol, names))


def _emphasized(names: Iterable[str]) -> Markup:
    return _listed(Markup("<em>{}</em>").format(name) for name in names)


def _law_text(law: UniversalLaw) -> Markup:
    """Return a control law: what the controls are, which of them are free, and what has to be positive for it."""
    text = _equalities(law.controls)
    for name in law.free:
        message = Markup(gettext("%(law)s, %(control)s any function of the time"))
        text = message % {"law": text, "control": mathematics.symbol(name)}
    if law.positive:
        conditions = _both(mathematics.expression(each) + " " + mathematics.tex("> 0") for each in law.positive)
        text = Markup(gettext("%(law)s, where %(conditions)s")) % {"law": text, "conditions": conditions}
    return text


def _rounded(value: float, digits: int = 6) -> str:
    return f"{float(f'{float(value):.{digits}g}'):.15g}"


def _signed(value: float) -> str:
    """Return a rounded number with its sign; nothing has a sign only where it is nothing."""
    return f"{value:+.0f}" if round(value) else gettext("under 1")


def _counted(message: str, count: int, none: str) -> str:
    """Return the message with the count in it, or that there are none."""
    return message % {"count": count} if count else none


def _complex_numbers(values: Sequence[complex]) -> Markup:
    """Complex numbers, of each conjugate pair both at once."""
    upper = [value for value in values if value.imag >= 0 or value.conjugate() not in values]
    return _listed(mathematics.tex(_complex_number(value, value.conjugate() in values)) for value in upper)


def _complex_number(value: complex, paired: bool) -> str:
    real = "" if abs(value.real) < NEGLIGIBLE * abs(value) else f"{value.real:.6g}"
    if not value.imag:
        return real
    sign = r"\pm" if paired else "+" if value.imag > 0 else "-"
    return rf"{real} {sign} {abs(value.imag):.6g}\,i"


def _coefficient(text: str) -> str:
    """Return an exact number that is short, or a rounded one."""
    return text if len(text) <= LONGEST_COEFFICIENT else f"{float(number(text)):.10g}"


def _maxima_text(text: str) -> Markup:
    """Return a reason of Maxima's, an expression that it names as code.

    In English where the catalog does not know it.
    """
    told = translated(text)
    marked = NAMED_BY_MAXIMA.sub(r"\1<code>\2</code>\3", str(escape(told)))
    foreign = told == text and spoken() != ENGLISH
    return Markup(f'<span lang="{ENGLISH}">{marked}</span>' if foreign else marked)


def _power_of_ten(value: float) -> Markup:
    """Return a small number with one digit and its power of ten."""
    if not value:
        return mathematics.tex("0")
    digit, exponent = f"{value:.0e}".split("e")
    return mathematics.tex(rf"{digit} \times 10^{{{int(exponent)}}}")


def _with_code(text: str) -> Markup:
    """Text with what stands between backquotes as code."""
    return Markup(CODE_IN_TEXT.sub(r"<code>\1</code>", str(escape(text))))


def _spelled_label(label: str) -> str:
    if label.isdecimal():
        return gettext("Chapter %(label)s", label=label)
    return gettext("Appendix %(label)s", label=label)
