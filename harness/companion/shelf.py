"""The chapters of one build: run, rendered and written."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ..files import write_whole
from ..typeset.quantities import spelled_apart
from .chapter import Chapter
from .pages import environment
from .stored_results import Results

FIGURES = "figures://"  # before the names of files that pages save; Sphinx leaves it as it is


class Shelf:
    """The chapters of a build.

    Parameters
    ----------
    chapters : mapping of str to Chapter
        The chapters, by the last part of the name of their page.
    language : str
        What templates and figures speak.
    files : Path
        Where the figures and other files of the pages are put.
    results : Results
        Results of runs.
    """

    def __init__(self, chapters: Mapping[str, Chapter], language: str, files: Path, results: Results) -> None:
        self.chapters, self.language, self.files, self.results = chapters, language, files, results
        self.known: dict[str, Mapping[str, Any]] = {}

    def perform(self, names: Iterable[str]) -> None:
        """Have the results of the runs that pages take.

        Parameters
        ----------
        names : iterable of str
            Names of the pages.
        """
        self.results.perform(run for name in names for run in self.chapter(name).runs.values())

    def chapter(self, name: str) -> Chapter:
        """Return the chapter of a page, one without runs by default.

        Parameters
        ----------
        name : str
            Name of the page.

        Returns
        -------
        Chapter
            Chapter of the page.
        """
        return self.chapters.get(name.rpartition("/")[2], Chapter())

    def values(self, name: str) -> Mapping[str, Any]:
        """Return a page's results, and the values that its head computes of them.

        Parameters
        ----------
        name : str
            Name of the page.

        Returns
        -------
        mapping of str to Any
            Values for the templates of the page.
        """
        if name not in self.known:
            chapter = self.chapter(name)
            results = {each: self.results[run] for each, run in chapter.runs.items()}
            self.known[name] = found = {"page": name, "save": self.save, "results": results, **results}
            for each, expression in chapter.values.items():
                found[each] = self._value(expression, found)
        return self.known[name]

    def figure(self, name: str, figure: str) -> str:
        """Draw a figure of a page.

        Parameters
        ----------
        name : str
            Name of the page.
        figure : str
            Name of the figure.

        Returns
        -------
        str
            Address of the SVG file.
        """
        return self.save(f"{figure}.svg", self._value(self.chapter(name).figures[figure], self.values(name)))

    def save(self, name: str, text: str) -> str:
        """Write a file that a page shows.

        Parameters
        ----------
        name : str
            Name of the file.
        text : str
            Its content.

        Returns
        -------
        str
            Address of the file.
        """
        self.files.mkdir(parents=True, exist_ok=True)
        write_whole(self.files / name, text)
        return FIGURES + name

    def rendered(self, name: str, template: str) -> str:
        """Return a part of a page, rendered with the results of its chapter.

        Parameters
        ----------
        name : str
            Name of the page.
        template : str
            Jinja template.

        Returns
        -------
        str
            HTML.
        """
        values = self.values(name)
        with spelled_apart(values["answers"].derived.record.system.names if "answers" in values else ()):
            return str(environment(self.language).from_string(template).render(values)).strip()

    def _value(self, expression: str, values: Mapping[str, Any]) -> Any:
        return environment(self.language).compile_expression(expression)(**values)
