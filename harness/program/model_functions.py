"""A scene's model as functions of time t, state y, controls u and parameters p.

The controls u include their time derivatives. ``law(t, p)`` returns u, and ``rhs(t, y, p)`` the derivative of y under
it. Both are missing if a control has no law. The other functions take (t, y, u, p):

- ``motion`` returns accelerations and multipliers,
- ``constraints`` returns residuals, their time derivatives and the Jacobian's entries,
- ``projection`` returns corrections of y,
- ``servo`` returns the controls of servo-constraints,
- ``observe`` returns the scene's own outputs.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from .c_source import FUNCTIONS, IN_SPAN, Target, statements
from .model import Model
from .motion_program import Program

HELPERS = frozenset({"pow", "square", "cube", IN_SPAN})  # what C's arithmetic calls besides `FUNCTIONS`


class ModelFunction(NamedTuple):
    """A function of a model that is a program."""

    name: str
    arguments: tuple[str, ...]  # of t, y, u and p
    program: Program


def model_functions(model: Model) -> Iterator[ModelFunction]:
    """Yield the functions of a model except ``rhs``.

    Parameters
    ----------
    model : Model

    Yields
    ------
    ModelFunction
        A function and its program.
    """
    programs = {
        "motion": model.motion,
        "constraints": model.constraints,
        "projection": model.projection,
        "servo": model.servo,
        "observe": model.outputs,
    }
    for name, program in programs.items():
        if program is not None:
            yield ModelFunction(name, ("t", "y", "u", "p"), program)
    if model.law is not None and has_law(model):
        outputs = {name: model.law.outputs[name] for name in model.histories}
        yield ModelFunction("law", ("t", "p"), replace(model.law, outputs=outputs))


def has_law(model: Model) -> bool:
    """Return True if each control has a law.

    Parameters
    ----------
    model : Model

    Returns
    -------
    bool
    """
    return set(model.controls) == set(model.under_law)


def body(function: ModelFunction, target: Target, inputs: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return a function's statements and its outputs as expressions.

    Parameters
    ----------
    function : ModelFunction
        Function of a model.
    target : Target
        Language of the statements.
    inputs : sequence of str
        Expression of each input in that language.

    Returns
    -------
    statements : list of str
        Assignments to local variables.
    outputs : list of str
        Expression of each output.
    """
    count = len(function.program.outputs)
    lines = list(statements(function.program, target, inputs, ["{value}"] * count))
    return lines[: len(lines) - count], lines[len(lines) - count :]


def given(model: Model, names: Iterable[str], unknown: str) -> str:
    """Return the scene's values of time, state or parameters, separated by commas.

    Parameters
    ----------
    model : Model
    names : iterable of str
        Names of time, state or parameters.
    unknown : str
        Text for a name without value, such as ``NAN``.

    Returns
    -------
    str
        Numbers separated by commas.
    """
    values = {**(model.start or {}), **model.values}
    return ", ".join(repr(float(values[name])) if name in values else unknown for name in names)


def called(text: str) -> set[str]:
    """Return the names of the functions of C's arithmetic that a text calls.

    Parameters
    ----------
    text : str
        Statements or expressions in C.

    Returns
    -------
    set of str
        Names such as ``sin`` and ``cube``.
    """
    return set(re.findall(r"\b([a-z]\w*)\(", text)) & {*FUNCTIONS.values(), *HELPERS}
