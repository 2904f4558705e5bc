"""The whole book as one PDF: its chapters in one document, which Chromium prints.

Each chapter is a named page of its own, so that its title is at the head of its pages. The numbers of the
pages are known only when they are printed: the document is printed twice, the second time with the numbers that the
first one gave to the places that the contents and the index name.
"""

import os
import posixpath
import re
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path

from markupsafe import Markup
from sphinx.application import Sphinx
from sphinx.environment.adapters.indexentries import IndexEntries

from ..extras import missing_package
from ..failures import ErrorKind, HolonomError
from ..files import write_whole
from ..language import translatable
from ..temporary import private_directory
from .directives import FILES
from .pages import environment

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
PATIENCE = 300  # seconds that the browser may take
PRINT = (
    "--headless=new --disable-gpu --disable-dev-shm-usage --disable-quic --disable-sync --disable-component-update "
    "--disable-background-networking --no-first-run --no-proxy-server --no-pdf-header-footer "
    "--generate-pdf-document-outline"
)
OFFLINE = "--host-resolver-rules=MAP * ~NOTFOUND"
ARTICLE = re.compile(r'<article role="main"[^>]*>(.*?)</article>', re.DOTALL)
REMOVED = re.compile(r'<div class="toctree-wrapper compound">.*?</div>|<a class="headerlink".*?</a>', re.DOTALL)
TITLE = re.compile(r"<h1>(.*?)</h1>", re.DOTALL)
IDENTIFIER = re.compile(r'\b(id|for|aria-labelledby)="([^"]+)"')
LINK = re.compile(r' href="(?!data:|http)([^"#]*)#?([^"]*)"')
PLACE = r"(?:.*/)?([^/]*)\.html#(.*)"  # of a page, and on it


def print_site(app: Sphinx, root: str, pdf: Path) -> None:
    """Print the pages below a root page that Sphinx has made as one book.

    Parameters
    ----------
    app : Sphinx
        Application.
    root : str
        Name of the root page.
    pdf : Path
        PDF file.

    Raises
    ------
    HolonomError
        There is no browser, it does not print, or the file cannot be written.
    """
    with private_directory() as folder:
        for name in (FILES, "_static"):
            (folder / name).symlink_to(Path(app.outdir, name).resolve())
        pages: dict[str, int] = {}
        for _ in range(2):
            page = folder / "book.html"
            page.write_text(one_document(app, root, pages), encoding="utf-8")
            printed = _printed(page)
            pages = _page_numbers(printed)
        write_whole(pdf, printed.read_bytes())


def one_document(app: Sphinx, root: str, numbers: Mapping[str, int]) -> str:
    """Return all pages below a root page in one document, with known page numbers.

    Parameters
    ----------
    app : Sphinx
        Application.
    root : str
        Name of the root page.
    numbers : mapping of str to int
        Page numbers by anchor.

    Returns
    -------
    str
        HTML document.
    """
    front, *chapters = (_chapter(app, name) for name in (root, *app.env.toctree_includes[root]))
    names = {each["name"] for each in chapters}
    terms = [
        {"text": text, "place": f"{page}.{anchor}"}
        for _, entries in IndexEntries(app.env).create_index(app.builder)
        for text, (links, _, _) in entries
        for page, anchor in (re.fullmatch(PLACE, uri).groups() for _, uri in links)
        if page in names
    ]
    language = app.config.language[:2]
    template = environment(language).get_template("print.html")
    return template.render(front=front, chapters=chapters, terms=terms, numbers=numbers, language=language)


def _chapter(app: Sphinx, name: str) -> dict[str, str]:
    """Return name, title and text of a page, with ids and links for one document."""
    text = ARTICLE.search(Path(app.outdir, f"{name}.html").read_text(encoding="utf-8"))[1]
    text = REMOVED.sub("", text).replace(f'="../{FILES}/', f'="{FILES}/')
    title, name = Markup(TITLE.search(text)[1]).striptags(), posixpath.basename(name)

    def linked(link: re.Match) -> str:
        page, anchor = link[1], link[2]
        if "/" in page or (page and not page.endswith(".html")):
            return ""
        return f' href="#{page.removesuffix(".html") or name}{f".{anchor}" if anchor else ""}"'

    text = IDENTIFIER.sub(rf'\1="{name}.\2"', text)
    return {"name": name, "title": title, "text": Markup(LINK.sub(linked, text))}


def browser() -> str:
    """Return the browser that prints.

    Returns
    -------
    str
        Path of the program.

    Raises
    ------
    HolonomError
        No browser is installed.
    """
    found = next(filter(None, map(shutil.which, BROWSERS)), None)
    if found is None:
        raise HolonomError(ErrorKind.BROWSER_MISSING)
    return found


def _printed(page: Path) -> Path:
    """Return the PDF that the browser makes of a page."""
    printed = page.with_suffix(".pdf")
    files = f"--user-data-dir={page.parent / 'profile'}", f"--print-to-pdf={printed}", page.as_uri()
    root = ["--no-sandbox"] if os.geteuid() == 0 else []  # Chromium's sandbox cannot be set up by root
    command = [browser(), *PRINT.split(), OFFLINE, *root, *files]
    try:
        told = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE).stderr.strip()
        reason = told.rpartition("\n")[2] or translatable("it wrote nothing")
    except subprocess.TimeoutExpired:
        reason = translatable("it took longer than %(limit)s s", limit=PATIENCE)
    if not printed.is_file():
        raise HolonomError(ErrorKind.NOT_PRINTED, detail=reason)
    return printed


def _page_numbers(pdf: Path) -> dict[str, int]:
    """Return the page number, from 1, of each place of a printed document."""
    try:
        from pypdf import PdfReader
    except ImportError:
        raise missing_package("pypdf") from None
    reader = PdfReader(pdf)
    return {
        name.removeprefix("/"): reader.get_destination_page_number(place) + 1
        for name, place in reader.named_destinations.items()
    }
