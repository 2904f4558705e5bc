"""The chapters of one build: run, rendered and written."""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from ..files import write_whole
from ..language import speaking
from .chapter import Chapter, Page, Run
from .pages import environment
from .runs import perform
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
        Where results of runs are kept from one build to the next.
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
        self.chapters, self.language, self.files, self.result_folder, self.done = (
            chapters,
            language,
            files,
            result_folder,
            done,
        )
        self.results = {} if results is None else results
        self.pages: dict[str, Page] = {}

    def perform(self, names: Iterable[str]) -> None:
        """Have the results of the runs that pages take.

        Parameters
        ----------
        names : iterable of str
            Names of the pages.
        """
        wanted = [run for name in names if (chapter := self.chapter(name)) for run in chapter.runs.values()]
        missing = [run for run in wanted if run not in self.results]
        self.results.update(results_of(missing, self.result_folder, partial(perform, done=self.done)))

    def chapter(self, name: str) -> Chapter | None:
        """Return the chapter of a page, where it has one.

        Parameters
        ----------
        name : str
            Name of the page.

        Returns
        -------
        Chapter or None
            Chapter, or None for a page without one.
        """
        return self.chapters.get(name.rpartition("/")[2])

    def page(self, name: str) -> Page:
        """Return the results of the chapter of a page, and write its files.

        Parameters
        ----------
        name : str
            Name of the page.

        Returns
        -------
        Page
            Content and files of the page.
        """
        if name not in self.pages:
            self.pages[name] = made = self._made(name)
            figures = {f"{figure}.svg": svg for figure, svg in made.figures.items()}
            for file, text in (figures | dict(made.files)).items():
                self._write(file, text)
        return self.pages[name]

    def rendered(self, name: str, template: str) -> str:
        """Return a piece of a page, rendered with the results of its chapter.

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
        with speaking(self.language):
            page, chapter = self.page(name), self.chapter(name)
            known = {each: self.results[run] for each, run in chapter.runs.items()} if chapter else {}
            return str(environment(self.language).from_string(template).render(known | dict(page.content))).strip()

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

    def _write(self, name: str, text: str) -> None:
        (self.files / name).parent.mkdir(parents=True, exist_ok=True)
        write_whole(self.files / name, text)

    def _made(self, name: str) -> Page:
        chapter = self.chapter(name)
        if chapter is None:
            return Page()
        with speaking(self.language):
            return chapter.page({each: self.results[run] for each, run in chapter.runs.items()})
