"""The book of the paper: its chapters and their order."""

from pathlib import Path

from ..files import shared
from ..language import translatable
from .book import APPENDICES, Book
from .chapters import (
    effects,
    equations_of_motion,
    free_motion,
    further_reading,
    gallery,
    hard_cases,
    initial_motion,
    misprints,
    notation,
    prescribed_reactions,
    radius_of_convergence,
    reference,
    the_system,
    trajectory_control,
    turn_the_knob,
    universal_controls,
    worked_example,
    your_own_system,
)
from .chapters import (
    work_precision as accuracy,
)
from .sessions import sessions

REPOSITORY = shared("maxima").parent

CHAPTERS = {
    translatable("The paper"): (the_system, equations_of_motion, free_motion, initial_motion, worked_example),
    translatable("What the paper left open"): (
        universal_controls,
        trajectory_control,
        prescribed_reactions,
        radius_of_convergence,
        turn_the_knob,
        accuracy,
        hard_cases,
        effects,
    ),
    APPENDICES: (misprints, notation, your_own_system, gallery, reference, further_reading),
}


def book_of_the_paper(root: Path = REPOSITORY) -> Book:
    """The companion of the paper.

    Parameters
    ----------
    root : Path
        The repository whose examples and Maxima files it shows.
    """
    parts = tuple((title, tuple(each.chapter(root) for each in chapters)) for title, chapters in CHAPTERS.items())
    return Book(
        title=translatable("Free motion and initial motion"),
        subtitle=translatable(
            "A textbook companion to Chen, Guo & Mei, “Free motion and initial motion of controllable holonomic system "
            "with redundant coordinates” (2019)"
        ),
        foreword="foreword.html",
        command="make companion",
        root=root,
        parts=parts,
        sessions=sessions(root, (chapter for _, chapters in parts for chapter in chapters)),
    )
