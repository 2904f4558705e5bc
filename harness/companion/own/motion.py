"""The motion of each scene: drawn, where the system says how it looks, and as curves."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..chapter import Chapter, Page, Run
from ..motions import Motion, figures_of, motions


def chapter(prefix: str, file: Path, study: Run) -> Chapter:
    """The chapter about a file, in whose pages' names the prefix comes first."""

    def page(results: Mapping[str, Any]) -> Page:
        found = results["motions"]
        titles = results["study"].titles
        scenes = [(f"{prefix}scene-{place}", titles[name], name) for place, name in enumerate(found, 1)]
        shown = [(figure, found[name]) for figure, _, name in scenes if isinstance(found[name], Motion)]
        return Page(
            {"scenes": [(figure, title, name, found[name]) for figure, title, name in scenes]},
            figures=figures_of(shown),
        )

    return Chapter(
        slug=f"{prefix}motion",
        title="The motion",
        aim="How the system moves, and what its constraints have to do.",
        template="own_motion.html",
        runs={"study": study, "motions": motions(*study.arguments)},
        page=page,
    )
