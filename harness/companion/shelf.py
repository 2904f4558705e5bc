"""The chapters of one build: run, rendered and written."""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from ..files import write_whole
from .chapter import FILES, Chapter
from .pages import environment
from .runs import Run, perform
from .stored_results import results_of


class Shelf:
    """The results of the chapters of a build.

    Parameters
    ----------
    chapters : mapping of str to Chapter
        The chapters, by the last part of the name of their page.
    language : str
        What templates and figures speak.
    files : Path
        Where the figures and other files of the pages are put.
    result_folder : Path or None
        Where results of runs are stored for later builds.
    results : dict, optional
        Those that are there already. Others are added.
    done : callable, optional
        Called each time that one of the runs is done.
    """

    def __init__(
        self,
        chapters: Mapping[str, Chapter],
        language: str,
        files: Path,
        result_folder: Path | None,
        results: dict[Run, Any] | None = None,
        done: Callable[[], None] = lambda: None,
    ) -> None:
        self.chapters, self.language, self.files = chapters, language, files
        self.result_folder, self.done = result_folder, done
        self.results = {} if results is None else results
        self.known: dict[str, Mapping[str, Any]] = {}

    def perform(self, names: Iterable[str]) -> None:
        """Have the results of the runs that pages take.

        Parameters
        ----------
        names : iterable of str
            Names of the pages.
        """
        wanted = [run for name in names for run in self.chapter(name).runs.values()]
        missing = [run for run in wanted if run not in self.results]
        self.results.update(results_of(missing, self.result_folder, partial(perform, done=self.done)))

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
        """Return the results of a page's runs and what its chapter computes of them.

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
            chapter, known = self.chapter(name), environment(self.language)
            found = {each: self.results[run] for each, run in chapter.runs.items()}
            found |= chapter.page(found)
            for each, expression in chapter.values.items():
                found[each] = known.compile_expression(expression)(**found)
            figures = {f"{each}.svg": known.compile_expression(svg)(**found) for each, svg in chapter.figures.items()}
            for file, text in (figures | found.get(FILES, {})).items():
                (self.files / file).parent.mkdir(parents=True, exist_ok=True)
                write_whole(self.files / file, text)
            self.known[name] = found
        return self.known[name]

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
        return str(environment(self.language).from_string(template).render(self.values(name))).strip()

    def result(self, run: Run) -> Any:
        """Return the result of a run, performed in this process unless it is known.

        Parameters
        ----------
        run : Run
            Run that is not one of a chapter's.

        Returns
        -------
        Any
            Its result.
        """
        if run not in self.results:
            self.results |= results_of(
                [run], self.result_folder, lambda runs: {each: each.compute(*each.arguments) for each in runs}
            )
        return self.results[run]
