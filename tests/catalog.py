"""The catalogs of messages: collected from the sources, and brought up to date.

`make catalog` runs this: it writes ``locale/holonom.pot`` anew and each language's catalog after it, and says what is
wrong in those. A message that is new has no translation yet; the translation of one that is gone is kept at the end, as
obsolete.
"""

import io
import re
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import IO, Any

from babel.messages.catalog import Catalog, Message
from babel.messages.extract import extract
from babel.messages.pofile import read_po, write_po

import holonom
from holonom.companion.pages import WHITESPACE
from holonom.files import shared, write_whole
from holonom.language import DOMAIN, ENGLISH, LANGUAGES, LOCALE, catalog_file

PACKAGE = Path(holonom.__file__).parent
TEMPLATE = LOCALE / f"{DOMAIN}.pot"
KEYWORDS = {"gettext": None, "ngettext": (1, 2), "translatable": None, "_": None}
STRING = r'"((?:[^"\\]|\\.)*)"'
IN_MAXIMA = re.compile(
    rf"\b(?:title|source)\s*=\s*{STRING}"  # of a system or a scene
    rf'|\bequation\("[^"]*",\s*"\w+",\s*{STRING}'  # names of equations
    rf'|\bprinted\("[^"]*",\s*{STRING}'
    rf'|\b(?:then|else) "(inverse[^"]*)"'
    rf'|"((?:Compared|Holds|Printed|What is)[^"]*\.)"'  # remarks on the print
)
IN_TOML = re.compile(rf"^(?:meaning|where|comment|heading|aim|drawing|curves) = {STRING}$", re.MULTILINE)
KEPT = {
    "placeholders": re.compile(r"%(?:\(\w+\)[.\d]*[a-z]|%)"),
    "marks": re.compile(r"<[^>]+>"),
    "formulas": re.compile(r"\$[^$]+\$"),
    "code": re.compile(r"`[^`]+`"),
}
"""What a translation has in common with its message."""
Found = Iterator[tuple[int, str, str, list[str]]]  # line, function, message, comments


def collected() -> Catalog:
    """The messages of the sources, in the order of their files."""
    catalog = Catalog(project=DOMAIN, charset="utf-8")
    for file, method, options in _sources():
        with file.open("rb") as text:
            for _, message, comments, _ in extract(method, text, KEYWORDS, options=options):
                catalog.add(message, None, [(_place(file), None)], auto_comments=comments)
    return catalog


def template_text(catalog: Catalog) -> str:
    """A catalog as a file has it: a message a line, without the lines of the sources and without dates."""
    written = io.BytesIO()
    write_po(written, catalog, width=0, omit_header=catalog.locale is None, include_lineno=False)
    return written.getvalue().decode()


def read_catalog(language: str) -> Catalog:
    """The catalog of a language as it is; empty where there is none."""
    file = catalog_file(language)
    if not file.exists():
        return Catalog(locale=language, project=DOMAIN, charset="utf-8")
    with file.open("rb") as text:
        return read_po(text, locale=language)


def update() -> None:
    """Write the template and the catalogs anew."""
    catalog = collected()
    write_whole(TEMPLATE, template_text(catalog))
    for language in LANGUAGES:
        if language != ENGLISH:
            known = read_catalog(language)
            known.update(catalog, no_fuzzy_matching=True, update_creation_date=False)
            write_whole(catalog_file(language), template_text(known))


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
    for what, pattern in KEPT.items():
        wanted = set(pattern.findall(_english(message)))
        for text in texts:
            if (found := set(pattern.findall(text))) != wanted:
                yield f"{what} differ, {', '.join(sorted(found ^ wanted))}"


def _english(message: Message) -> str:
    """The message, of one with a plural that."""
    return message.id if isinstance(message.id, str) else message.id[1]


def _sources() -> Iterator[tuple[Path, Any, Mapping[str, Any]]]:
    """The files that have messages, how each is read, and the options of that."""
    pages = {name: str(value).lower() for name, value in WHITESPACE.items()}
    for file in sorted(PACKAGE.rglob("*.html")):
        yield file, "jinja2", {**pages, "extensions": "jinja2.ext.i18n", "silent": "false"}
    for file in sorted(PACKAGE.rglob("*.toml")):
        yield file, _in_toml, {}
    for file in sorted(PACKAGE.rglob("*.py")):
        yield file, "python", {}
    for folder in ("examples", "maxima"):
        for file in sorted(shared(folder).rglob("*.mac")):
            yield file, _in_maxima, {}


def _place(file: Path) -> str:
    """A file as it is named from the top of the repository."""
    return (
        f"harness/{file.relative_to(PACKAGE)}"
        if file.is_relative_to(PACKAGE)
        else str(file.relative_to(PACKAGE.parent))
    )


def _in_maxima(file: IO[bytes], keywords: Collection[str], tags: Collection[str], options: Mapping[str, Any]) -> Found:
    """Titles, sources, names of equations and remarks in a Maxima file."""
    text = re.sub(r"/\*.*?\*/", "", file.read().decode(), flags=re.DOTALL)
    for found in IN_MAXIMA.finditer(text):
        message = " ".join(next(filter(None, found.groups()), "").split())
        if message:
            yield 0, "gettext", message.replace('\\"', '"'), []


def _in_toml(file: IO[bytes], keywords: Collection[str], tags: Collection[str], options: Mapping[str, Any]) -> Found:
    """What readers see of the data of the companion."""
    for found in IN_TOML.finditer(file.read().decode()):
        yield 0, "gettext", found[1].replace('\\"', '"'), []


if __name__ == "__main__":
    update()
    for language in LANGUAGES:
        if language != ENGLISH:
            print(*(f"{language}: {fault}" for fault in faults(read_catalog(language))), sep="\n")
