"""Directives and roles that put runs into the pages of the book and the manual.

``{value}`EXPRESSION` `` is a value of the page's runs within a line, ``{show} EXPRESSION`` a block of it: a card of an
equation, an answer, a table. An expression is Jinja's, over what the page's chapter computes and the macros of the
templates. ``{show}`` without one takes a part of a template as its content. ``{run-figure} NAME`` is a figure of the
chapter with its caption.
``{exercise} GRADE`` is a question, ``{answer}`` the answer to the question in the same place of their order.
``{chapter}`chapter {number} <NAME>` `` is a link to a chapter with its number; Sphinx's ``numref`` would read all pages
for every build.
"""

from gettext import NullTranslations
from pathlib import Path
from typing import Any

from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po
from docutils import nodes
from docutils.parsers.rst.directives.images import Figure
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.config import Config
from sphinx.environment import BuildEnvironment
from sphinx.roles import XRefRole
from sphinx.util.docutils import SphinxDirective, SphinxRole
from sphinx.util.nodes import make_refnode
from sphinx.writers.html5 import HTML5Translator

from ..language import ENGLISH, catalog_file, gettext, translatable
from ..typeset.mathml import inline_mathml, mathml
from . import EXAMPLES
from .chapter import chapters_of_the_paper
from .finish import EQUATION, with_columns, with_equations
from .runs import Run
from .sessions import answers_of
from .shelf import FIGURES, Shelf
from .stored_results import Results, digest_of_all

BOOK = "book"
PROMPT = "holonom_prompt"  # the example and the statements of a page, among the data of the page that is read
SHELF = "holonom_shelf"  # the chapters, among the data of the page that is read
RESULTS = ".results"  # the folder of results that a later build takes
FILES = "_runs"  # the folder of results of runs, in the folder of the pages
# Texts of the theme, which Sphinx's own catalogs do not have.
THEME = translatable("Skip to content"), translatable("Back to top"), translatable("On this page")
THEME += translatable("Next"), translatable("Previous"), translatable("Home"), translatable("Made with ")


class Show(SphinxDirective):
    """HTML that an expression, or a part of a template, makes of the runs."""

    optional_arguments, final_argument_whitespace, has_content = 1, True, True

    def run(self) -> list[nodes.Node]:
        """Return the HTML, and label its equations.

        Returns
        -------
        list of docutils.nodes.Node
            Nodes of the page.
        """
        template = "\n".join(self.content) or f"{{{{ {self.arguments[0]} }}}}"
        html = _rendered(self.env, template)
        for number in EQUATION.findall(html):
            self.env.domains.standard_domain.anonlabels.setdefault(f"eq-{number}", (self.env.docname, f"eq-{number}"))
        return [_html(html)]


class Value(SphinxRole):
    """A value of a run within a line."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Return the value of the expression.

        Returns
        -------
        tuple of two lists
            Nodes, and messages of the system.
        """
        return [_html(_rendered(self.env, f"{{{{ {self.text} }}}}"))], []


class Session(SphinxDirective):
    """Statements at Maxima's prompt, one a line, with the answers.

    A session continues those before it on the page.
    """

    optional_arguments, has_content = 1, True

    def run(self) -> list[nodes.Node]:
        """Return statements and answers under their numbers.

        Returns
        -------
        list of docutils.nodes.Node
            Nodes of the page.
        """
        shelf = self.env.temp_data[SHELF]
        if shelf is None:
            return []
        example, known = self.env.temp_data.get(PROMPT, (None, ()))
        example = EXAMPLES / self.arguments[0] if self.arguments else example
        asked = (*known, *(each.rstrip(";$") for each in self.content))
        self.env.temp_data[PROMPT] = example, asked
        answers = shelf.results[Run(answers_of, (example, asked))][len(known) :]
        numbered = enumerate(zip(self.content, answers, strict=True), len(known) + 1)
        lines = [
            f"(%i{place}) {each}" + ("" if each.endswith("$") else f"\n(%o{place}) {answer}")
            for place, (each, answer) in numbered
        ]
        text = "\n".join(lines)
        return [nodes.literal_block(text, text, language="text", classes=["session"])]


class When(SphinxDirective):
    """Content for the case that a condition on the runs holds."""

    required_arguments, final_argument_whitespace, has_content = 1, True, True

    def run(self) -> list[nodes.Node]:
        """Return the content if the condition holds, or while messages are collected.

        Returns
        -------
        list of docutils.nodes.Node
            Nodes of the page.
        """
        condition = f"{{{{ 1 if {self.arguments[0]} else '' }}}}"
        holds = self.env.temp_data[SHELF] is None or _rendered(self.env, condition)
        return self.parse_content_to_nodes() if holds else []


class RunFigure(Figure):
    """A figure that the chapter draws, with its text alternative as the option alt."""

    def run(self) -> list[nodes.Node]:
        """Return the figure, which is a link to its picture.

        Returns
        -------
        list of docutils.nodes.Node
            Nodes of the page.
        """
        env, (name,) = self.state.document.settings.env, self.arguments
        shelf = env.temp_data[SHELF]
        picture = shelf.figure(env.docname, name) if shelf else FIGURES
        self.arguments, self.options["target"], self.options["name"] = [picture], picture, f"fig-{name}"
        return super().run()


class Exercise(SphinxDirective):
    """A question, with its grade and a link to its answer."""

    required_arguments, has_content = 1, True

    def run(self) -> list[nodes.Node]:
        """Return the question.

        Returns
        -------
        list of docutils.nodes.Node
            Nodes of the page.
        """
        number, grade = 1 + self.env.new_serialno("exercise"), int(self.arguments[0])
        label = (gettext("easy"), gettext("middling"), gettext("hard"))[grade - 1]
        begin = (
            f'<div class="exercise" id="exercise-{number}"><a class="number" href="#answer-{number}">{number}</a> '
            f'<span class="grade" role="img" aria-label="{label}">{"●" * grade:○<3}</span>'
        )
        return [_html(begin), *self.parse_content_to_nodes(), _html("</div>")]


class Answer(SphinxDirective):
    """The answer of the exercise with the same number, folded."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Return the answer.

        Returns
        -------
        list of docutils.nodes.Node
            Nodes of the page.
        """
        number = 1 + self.env.new_serialno("answer")
        title = gettext("Answer")
        begin = f'<details id="answer-{number}"><summary>{title} {number}</summary><div class="answer">'
        return [_html(begin), *self.parse_content_to_nodes(), _html("</div></details>")]


def _html(text: str) -> nodes.raw:
    """Return HTML as a node."""
    return nodes.raw("", text, format="html")


def _collecting(app: Sphinx) -> bool:
    """Return True if messages are collected, without runs."""
    return app.builder.name == "gettext"


def _rendered(env: BuildEnvironment, template: str) -> str:
    """Return a part of a template, rendered with the runs of the current page."""
    shelf = env.temp_data[SHELF]
    return shelf.rendered(env.docname, template) if shelf else ""


def _put_shelf(app: Sphinx, name: str, source: list[str]) -> None:
    """Make the chapters available to the directives of a page."""
    app.env.temp_data[SHELF] = None if _collecting(app) else _shelf_of(app)


def _shelf_of(app: Sphinx) -> Shelf:
    """Return the chapters of a build, those of the paper where no others were given."""
    if not hasattr(app, "holonom_shelf"):
        files, results = Path(app.outdir) / FILES, Results(Path(app.doctreedir).parent / RESULTS)
        app.holonom_shelf = Shelf(chapters_of_the_paper(), _language_of(app), files, results)
    return app.holonom_shelf


def _visit_math(translator: HTML5Translator, node: nodes.math) -> None:
    """Write a formula within a line."""
    translator.body.append(inline_mathml(node.astext()))
    raise nodes.SkipNode


def _visit_math_block(translator: HTML5Translator, node: nodes.math_block) -> None:
    """Write a formula on lines of its own."""
    translator.body.append(f'<div class="formula">{mathml(node.astext())}</div>')
    raise nodes.SkipNode


def _perform_runs(app: Sphinx, env: BuildEnvironment, names: list[str]) -> None:
    """Have the results that the pages to be read take."""
    if not _collecting(app):
        _shelf_of(app).perform(names)


def _outdated(app: Sphinx, env: BuildEnvironment, added: set[str], changed: set[str], removed: set[str]) -> list[str]:
    """Remove pages without a text. Return pages whose results may have changed."""
    for name in removed if app.builder.name == "html" else ():
        Path(app.builder.get_outfilename(name)).unlink(missing_ok=True)
    before, now = getattr(env, "holonom_program", ""), digest_of_all()
    env.holonom_program = now
    shelf = _shelf_of(app)
    same = before == now and shelf.results.folder is not None
    return [] if same else [name for name in env.found_docs if shelf.chapter(name).runs]


def _chapter_with_number(
    app: Sphinx, env: BuildEnvironment, node: addnodes.pending_xref, content: nodes.TextElement
) -> nodes.reference | None:
    """Return the link to a chapter."""
    name = f"{BOOK}/{node['reftarget']}"
    if node["reftype"] != "chapter" or name not in env.toc_secnumbers:
        return None
    text = content.astext().format(number=".".join(map(str, env.toc_secnumbers[name][""])))
    return make_refnode(app.builder, node["refdoc"], name, None, nodes.inline("", text))


def _finish_page(app: Sphinx, name: str, template: str, context: dict[str, Any], tree: nodes.document | None) -> None:
    """Link equations and figures of a page, and name the columns of its tables."""
    if "body" in context and app.builder.name == "html":
        body = context["body"].replace(f'="{FIGURES}', f'="{context["pathto"](FILES, resource=True)}/')
        context["body"] = with_columns(with_equations(body, _places_from(app, name, body)))


def _places_from(app: Sphinx, name: str, body: str) -> dict[str, str]:
    """Return the link to each equation from a page, to its own first."""
    others = {
        label.removeprefix("eq-"): f"{app.builder.get_relative_uri(name, page)}#{label}"
        for label, (page, _) in app.env.domains.standard_domain.anonlabels.items()
        if label.startswith("eq-") and page.startswith(f"{BOOK}/")
    }
    return others | {number: f"#eq-{number}" for number in EQUATION.findall(body)}


def _language_of(app: Sphinx) -> str:
    """Return the language that messages are translated into: zh of zh_CN."""
    return (app.config.language or ENGLISH).partition("_")[0]


def _compile_catalogs(app: Sphinx, config: Config) -> None:
    """Make the catalogs ready for Sphinx, whose Chinese is called zh_CN."""
    language = _language_of(app)
    theme = NullTranslations()
    theme.gettext = gettext
    app.translator.add_fallback(theme)
    config.locale_dirs = [str(Path(app.doctreedir) / "locale")]
    target = Path(config.locale_dirs[0], config.language, "LC_MESSAGES")
    target.mkdir(parents=True, exist_ok=True)
    for file in catalog_file(language).parent.glob("*.po"):
        with file.open("rb") as text, (target / f"{file.stem}.mo").open("wb") as compiled:
            write_mo(compiled, read_po(text, locale=language))


def setup(app: Sphinx) -> dict[str, bool]:
    """Register all of this with Sphinx.

    Parameters
    ----------
    app : Sphinx
        Application.

    Returns
    -------
    dict of str to bool
        Properties of the extension.
    """
    app.add_directive("show", Show)
    app.add_directive("when", When)
    app.add_directive("session", Session)
    app.add_directive("run-figure", RunFigure)
    app.add_directive("exercise", Exercise)
    app.add_directive("answer", Answer)
    app.add_role("value", Value())
    app.add_role("chapter", XRefRole(warn_dangling=True))
    app.add_html_math_renderer("mathml", (_visit_math, None), (_visit_math_block, None))
    app.connect("config-inited", _compile_catalogs)
    app.connect("env-get-outdated", _outdated)
    app.connect("env-before-read-docs", _perform_runs)
    app.connect("source-read", _put_shelf)
    app.connect("missing-reference", _chapter_with_number)
    app.connect("html-page-context", _finish_page)
    return {"parallel_read_safe": False, "parallel_write_safe": True}
