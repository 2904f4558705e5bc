"""The catalogs of messages: collected from the sources, and brought up to date.

`make catalog` runs this: it writes ``locale/holonom.pot`` anew and each language's catalog after it, and says what is
wrong in those. A message that is new has no translation yet; the translation of one that is gone is dropped.
"""

import io
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import IO, Any

from babel.messages.catalog import Catalog, Message
from babel.messages.extract import extract
from babel.messages.pofile import read_po, write_po
from jinja2.ext import babel_extract
from sphinx.application import Sphinx
from sphinx.util.docutils import docutils_namespace, patch_docutils

import holonom
from holonom.companion import TEMPLATES
from holonom.companion.chapter import head_of
from holonom.companion.pages import WHITESPACE
from holonom.error_messages import pattern_of
from holonom.failures import ErrorKind
from holonom.files import shared, write_whole
from holonom.language import DOMAIN, ENGLISH, LANGUAGES, LOCALE, catalog_file

PACKAGE = Path(holonom.__file__).parent
TEMPLATE = LOCALE / f"{DOMAIN}.pot"
KEYWORDS = {"gettext": None, "ngettext": (1, 2), "translatable": None, "_": None}
STRING = r'"((?:[^"\\]|\\[\s\S])*)"'
IN_MAXIMA = re.compile(
    rf"\b(?:title|source)\s*=\s*{STRING}"  # of a system or a scene
    rf'|\bequation\("[^"]*",\s*"\w+",\s*{STRING}'  # names of equations
    rf'|\bprinted\("[^"]*",\s*{STRING}'
    rf"|\bworded\(\s*{STRING}"  # reasons of results, parts of errors
    rf'|\b(?:then|else) "(inverse[^"]*|multipliers, [^"]*)"'
    rf'|"((?:Compared|Holds|Printed|What is)[^"]*\.)"'  # notes on the print
)
REFUSAL = re.compile(rf"^  \['\w+, {STRING},\s+((?:{STRING}[,\s]*)+)\]", re.MULTILINE)
JINJA = {
    **{name: str(value).lower() for name, value in WHITESPACE.items()},
    "extensions": "jinja2.ext.i18n",
    "silent": "false",
}
SHOWN_IN_TOML = {"drawing", "curves", "words", "without_controls", "nothing"}
EXPECTED = re.compile(
    r"%(?:\(\w+\)[.\d]*[a-z]|%)"  # placeholders
    r"|<[^>!]+>"  # marks
    r"|\$[^$]+\$"  # formulas
    r"|(?:\{\w+\})?`[^`]+`"  # code
)
"""What a translation has in common with its message."""
TRANSLATED = ("book", "manual", "own")  # folders of pages in other languages; the reference is in English
SHOWN = re.compile(r"^```\{show\}\n(.*?)^```$", re.MULTILINE | re.DOTALL)
VALUE = re.compile(r"\{value\}`([^`]+)`")
ALIKE = re.compile(r"\$[^$]*\$|`[^`]*`|\{\w+\}`[^`]*`|\[\]\([^)]*\)|[^$`]*\\[^$`]*|Holonom", re.DOTALL)
"""What is the same in every language."""
Found = Iterator[tuple[int, str, str, list[str]]]  # line, function, message, comments


def collected() -> Catalog:
    """The messages of the sources, in the order of their files."""
    catalog = Catalog(project=DOMAIN, charset="utf-8")
    for folder, pattern, method in SOURCES:
        for file in sorted(folder.rglob(pattern)):
            with file.open("rb") as text:
                for _, message, comments, _ in extract(method, text, KEYWORDS, options=JINJA):
                    catalog.add(message, None, [(str(file.relative_to(PACKAGE.parent)), None)], auto_comments=comments)
    for kind in ErrorKind:
        for text in (kind.reason, *kind.hints):
            catalog.add(pattern_of(text), None, [("harness/failures.py", None)])
    return catalog


def template_text(catalog: Catalog) -> str:
    """A catalog as a file has it: a message a line, without the lines of the sources and without dates."""
    written = io.BytesIO()
    write_po(written, catalog, width=0, omit_header=catalog.locale is None, include_lineno=False, ignore_obsolete=True)
    return written.getvalue().decode()


def read_catalog(language: str, name: str = DOMAIN) -> Catalog:
    """A catalog of a language as it is; empty where there is none."""
    file = catalog_file(language, name)
    empty = Catalog(locale=language, project=name, charset="utf-8")
    return read_catalog_file(file, language) if file.exists() else empty


def read_catalog_file(file: Path, language: str | None = None) -> Catalog:
    """A catalog or a template."""
    with file.open("rb") as text:
        return read_po(text, locale=language)


def update() -> None:
    """Write the template and the catalogs anew."""
    with TemporaryDirectory() as folder:
        templates = {DOMAIN: collected(), **page_templates(Path(folder))}
    write_whole(TEMPLATE, template_text(templates[DOMAIN]))
    for language in LANGUAGES:
        for name, catalog in templates.items() if language != ENGLISH else ():
            known = read_catalog(language, name)
            known.update(catalog, no_fuzzy_matching=True, update_creation_date=False)
            write_whole(catalog_file(language, name), template_text(known))


def faults(catalog: Catalog) -> list[str]:
    """What is wrong in a catalog, a line each: no translation, a fuzzy one, other placeholders, marks or formulas."""
    return [f"{fault}: {_english(message)}" for message in catalog if message.id for fault in _faults(message)]


def _faults(message: Message) -> Iterator[str]:
    texts = message.string if isinstance(message.string, tuple) else (message.string,)
    if not all(texts):
        yield "no translation"
        return
    if message.fuzzy:
        yield "fuzzy"
    for text in texts:
        if different := _unchanged(text) ^ _unchanged(_english(message)):
            yield f"{', '.join(sorted(different))} differ"


def _unchanged(text: str) -> set[str]:
    """What a text has in every language, without the words that it defines and the names of chapters."""
    return {found for found in EXPECTED.findall(text) if not found.startswith(("{index}", "{chapter}"))}


def _english(message: Message) -> str:
    """The message, of one with a plural that."""
    return message.id if isinstance(message.id, str) else message.id[1]


def _in_maxima(file: IO[bytes], *others: Any, **options: Any) -> Found:
    """Titles, sources, names of equations, notes, reasons and errors in a Maxima file."""
    text = re.sub(r"/\*.*?\*/", "", file.read().decode(), flags=re.DOTALL).replace("\\\n", "")
    messages = [next(filter(None, found.groups()), "") for found in IN_MAXIMA.finditer(text)]
    errors = [message for row in REFUSAL.finditer(text) for message in re.findall(STRING, row[2])]
    messages += [re.sub(r"\{(\d)\}", r"%(fact\1)s", message).rstrip(".") for message in errors]
    for message in messages:
        if not re.fullmatch(r"(%\(fact\d\)s)?", message):
            yield 0, "gettext", re.sub(r"\s+", " ", message.replace('\\"', '"')), []


def _in_markdown(file: IO[bytes], keywords: Any, tags: Any, options: Mapping[str, Any]) -> Found:
    """The messages in the pieces of templates within a page of the book or the manual."""
    text = file.read().decode()
    head = head_of(text)
    values = [*head.get("values", {}).values(), *head.get("figures", {}).values(), *VALUE.findall(text)]
    pieces = [*SHOWN.findall(text), *(f"{{{{ {value} }}}}" for value in values)]
    yield from babel_extract(io.BytesIO("\n".join(pieces).encode()), keywords, tags, options)


def _in_toml(file: IO[bytes], *others: Any, **options: Any) -> Found:
    """What readers see of the data of the companion."""
    content = tomllib.load(file)
    for part in (*content.pop("exhibit", ()), *content.values()):
        yield from ((0, "gettext", text, []) for key, text in part.items() if key in SHOWN_IN_TOML)


def page_templates(folder: Path) -> dict[str, Catalog]:
    """The messages of the pages of the book and the manual, by the names of their catalogs."""
    package, left_out = PACKAGE / "companion", ["reference", "templates"]
    settings = {"exclude_patterns": left_out, "suppress_warnings": ["toc", "myst"]}
    with patch_docutils(package), docutils_namespace():
        Sphinx(package, package, folder, folder / "doctrees", "gettext", settings, status=None).build()
    return {name: _to_translate(folder / f"{name}.pot") for name in TRANSLATED}


def _to_translate(file: Path) -> Catalog:
    """The messages of a template of Sphinx's but those that are code or a formula alone."""
    catalog = Catalog(project=DOMAIN, charset="utf-8")
    for message in read_catalog_file(file):
        if message.id and not ALIKE.fullmatch(message.id):
            catalog.add(message.id, None, [(name, None) for name in dict(message.locations)])
    return catalog


SOURCES = (
    (PACKAGE, "*.html", "jinja2"),
    (TEMPLATES, "*.svg", "jinja2"),
    (TEMPLATES.parent, "*.md", _in_markdown),
    (TEMPLATES, "*.toml", _in_toml),
    (PACKAGE, "*.py", "python"),
    (shared("examples"), "*.mac", _in_maxima),
    (shared("maxima"), "*.mac", _in_maxima),
)
"""Folders, the files in them that have messages, and how each is read."""


if __name__ == "__main__":
    update()
    for file in sorted(LOCALE.rglob("*.po")):
        print(*(f"{file.name}: {fault}" for fault in faults(read_catalog_file(file))), sep="\n")
