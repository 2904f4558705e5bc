"""Show a description on the console, entry by entry."""

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from rich.console import Console

from ..expression.notation import scene_text
from ..expression.trees import Tree
from .heading import heading

if TYPE_CHECKING:
    from ..described import System
    from ..description import DescribedScene, Description


def show_description(console: Console, description: "Description") -> None:
    """Print a description in the words of the scene files.

    Parameters
    ----------
    console : Console
        Console to print on.
    description : Description
        Content of one scene file.
    """
    system = description.system
    console.print(system.title, style="bold")
    if system.source:
        console.print(system.source, style="dim")
    _show(console, _entries_of_system(system))
    for scene in description.scenes:
        console.print(f"\n{heading(scene.name, scene.title)}", style="bold")
        _show(console, _entries_of_scene(scene))
    for place, table in enumerate(description.tables):
        (first, _), (last, _) = table.points[0], table.points[-1]
        what = f"{len(table.points)} points from t = {scene_text(first)} to {scene_text(last)}"
        console.print(f"\ntable_{place}: {what}", soft_wrap=True, markup=False)


def _show(console: Console, entries: Iterable[tuple[str, list[str]]]) -> None:
    for name, lines in entries:
        if lines:
            console.print(name, style="cyan")
            console.print("\n".join(f"    {line}" for line in lines), soft_wrap=True, markup=False)


def _entries_of_system(system: "System") -> Iterator[tuple[str, list[str]]]:
    yield "coordinates", _names(system.coordinates)
    yield "controls", _names(system.controls)
    yield "parameters", _names(system.parameters)
    yield "switches", _names(system.switches)
    yield "kinetic_energy", [f"{part.effect} = {scene_text(part.tree)}" for part in system.kinetic_energy]
    yield "potential_energy", [f"{part.effect} = {scene_text(part.tree)}" for part in system.potential_energy]
    yield "forces", [f"{part.effect} = [{', '.join(map(scene_text, part.trees))}]" for part in system.forces]
    yield "constraints", _zeros(system.constraint_trees)
    yield "orientations", [scene_text(tree) for tree in system.orientation_trees]


def _entries_of_scene(scene: "DescribedScene") -> Iterator[tuple[str, list[str]]]:
    yield "effects", _names(scene.effects)
    yield "control_law", _values(scene.control_law.trees)
    yield "prescribed_reactions", _values(scene.prescribed_reactions.trees)
    yield "servo_constraints", _zeros(scene.servo_trees)
    yield "parameter_values", _values(scene.parameter_values.trees)
    yield "initial_state", _values(scene.initial_state.trees)
    yield "initial_guess", _values(scene.initial_guess.trees)
    yield "nominal", _values(scene.nominal.trees)
    yield "time_span", [", ".join(map(scene_text, scene.span_trees))] if scene.span_trees else []
    yield "until", _zeros(scene.until_trees)
    yield "released", [f"{', '.join(names)} at {scene_text(tree)} = 0" for tree, names in scene.released]
    yield "observe", [*_names(scene.observe), *_values(scene.outputs.trees)]


def _names(names: Iterable[str]) -> list[str]:
    joined = ", ".join(names)
    return [joined] if joined else []


def _values(trees: Mapping[str, Tree]) -> list[str]:
    return [f"{name} = {scene_text(tree)}" for name, tree in trees.items()]


def _zeros(trees: Iterable[Tree]) -> list[str]:
    return [f"{scene_text(tree)} = 0" for tree in trees]
