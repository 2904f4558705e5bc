"""The whole book as one PDF: its chapters in one document, which Chromium prints.

Each chapter is a named page of its own, so that its title can stand at the head of its sheets. The numbers of the
sheets are known only when they are printed: the document is printed twice, the second time with the numbers that the
first one gave to the places that the contents and the index name.
"""

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path

from markupsafe import Markup

from ..extras import missing_package
from ..failures import Failure, HolonomError
from .pages import Contents, printed_page

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
PATIENCE = 300  # seconds that the browser may take
PRINT = (
    "--headless=new",
    "--disable-gpu",
    "--disable-quic",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-proxy-server",
    "--host-resolver-rules=MAP * ~NOTFOUND",
    "--no-pdf-header-footer",
    "--generate-pdf-document-outline",
)
ARTICLE = re.compile(r"<article>(.*)</article>", re.DOTALL)
FRONT = re.compile(r'<main id="main">(.*?)<nav id="contents"', re.DOTALL)
IDENTIFIER = re.compile(r'\b(id|for|aria-labelledby)="([^"]+)"')
LINK = re.compile(r' href="(?!data:|http)([^"#]*)(#[^"]*)?"')


def print_book(contents: Contents, files: Mapping[str, str | bytes], pdf: Path) -> None:
    """Print a book, given all that it consists of by name: pages, figures, style and font.

    Raises
    ------
    HolonomError
        There is no browser, it does not print, or the file cannot be written.
    """
    from ..files import write_whole

    with tempfile.TemporaryDirectory(prefix="holonom-") as folder:
        directory = Path(folder)
        for name, content in files.items():
            if not name.endswith(".html"):
                (directory / name).parent.mkdir(parents=True, exist_ok=True)
                (directory / name).write_bytes(content.encode() if isinstance(content, str) else content)
        sheets: dict[str, int] = {}
        for _ in range(2):
            page = directory / "book.html"
            page.write_text(one_document(contents, files, sheets), encoding="utf-8")
            printed = _printed(page)
            sheets = sheets_of(printed)
        write_whole(pdf, printed.read_bytes())


def browser() -> str:
    """Return the browser that prints, or the refusal where none is installed."""
    found = next(filter(None, map(shutil.which, BROWSERS)), None)
    if found is None:
        raise HolonomError(Failure.BROWSER_MISSING)
    return found


def one_document(contents: Contents, files: Mapping[str, str | bytes], sheets: Mapping[str, int]) -> str:
    """Return all chapters in one document, ids and links made to fit."""
    chapters = [
        (entry, _fitted(ARTICLE.search(files[f"{entry.slug}.html"])[1], entry.slug)) for entry in contents.entries
    ]
    front = _fitted(FRONT.search(files["index.html"])[1], "index")
    return printed_page(contents, Markup(front), [(entry, Markup(text)) for entry, text in chapters], sheets)


def _fitted(text: str, slug: str) -> str:
    """Return the text of a page with its ids and links as they are in one document; what leads out of it is no link."""

    def linked(link: re.Match) -> str:
        page, anchor = link[1], (link[2] or "")[1:]
        if "/" in page or (page and not page.endswith(".html")):
            return ""
        place = page.removesuffix(".html") or slug
        return f' href="#{place}.{anchor}"' if anchor else f' href="#{place}"'

    text = IDENTIFIER.sub(lambda found: f'{found[1]}="{slug}.{found[2]}"', text)
    return LINK.sub(linked, text)


def _printed(page: Path) -> Path:
    """Return the PDF that the browser makes of a page."""
    printed = page.with_suffix(".pdf")
    root = ["--no-sandbox"] if os.geteuid() == 0 else []  # Chromium's sandbox refuses to be set up by root
    command = [browser(), *PRINT, *root, f"--user-data-dir={page.parent / 'profile'}", f"--print-to-pdf={printed}"]
    try:
        done = subprocess.run([*command, page.as_uri()], capture_output=True, text=True, timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        raise HolonomError(Failure.NOT_PRINTED, detail=f"it took longer than {PATIENCE} s") from None
    if not printed.is_file():
        raise HolonomError(Failure.NOT_PRINTED, detail=(done.stderr.strip().splitlines() or ["it wrote nothing"])[-1])
    return printed


def sheets_of(pdf: Path) -> dict[str, int]:
    """Return the sheet, from 1 on, that each place of a printed document is on."""
    try:
        from pypdf import PdfReader
    except ImportError:
        raise missing_package("pypdf") from None
    reader = PdfReader(pdf)
    return {
        name.removeprefix("/"): reader.get_destination_page_number(place) + 1
        for name, place in reader.named_destinations.items()
    }
