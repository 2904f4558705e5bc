"""Translatable reasons that Maxima gives for its results on free motion."""

import re

from .language import Message


def _(pattern: str) -> str:
    """Mark a pattern for the catalogs."""
    return pattern


REASONS = (
    _("the constraints, solved for the controls along the free motion"),
    _("the free motion keeps the constraints, whatever the controls do"),
    _("the free motion leaves a constraint that contains no control"),
    _("the motion is free, and there are no controls to choose"),
    _("the system has no controls, and the motion is not free"),
    _("the system has no controls, and this motion is not free"),
    _("the system has no controls, and whether the motion is free is undecided"),
    _("the system has no controls, and the condition does not vanish in every state"),
    _("the system has no controls, and the coefficient of %(place)s in (10), from %(effects)s, is %(value)s"),
    _("no control law makes every motion free: the coefficient of %(place)s in (10), from %(effects)s, is %(value)s"),
    _("no control law makes every motion free: the term without coordinates in (10), from %(effects)s, is %(value)s"),
    _("no law of the controls makes %(value)s vanish"),
    _("no law satisfies all coefficients of the condition at once"),
    _("it is open whether %(value)s vanishes"),
    _("the controls follow from the servo-constraints"),
    _("there are no constraints: every motion is free"),
    _("the solutions of all coefficients of the condition"),
    _("the condition holds for every control"),
    _("the condition (10) vanishes identically"),
    _("the condition (10) vanishes identically, whatever the controls do"),
    _("the condition (10) follows from the constraints and their first rates"),
    _("the differential equations for the controls could not be solved"),
    _("an equation for the controls could not be solved"),
    _("the initial state does not determine the initial values of the controls"),
    _("df/du is singular at the initial state: its rank is %(rank)s of %(size)s"),
    _("df/du is singular at the initial state, for every choice of %(count)s of the controls"),
    _("there are fewer controls than constraints, %(controls)s and %(constraints)s"),
    _("the power series of %(multiplier)s begins at order %(order)s"),
    _("the power series of the multipliers vanish to order %(order)s"),
)
EXPRESSIONS = {"place", "effects", "value"}  # only these contain spaces
PLACEHOLDER = re.compile(r"%\((\w+)\)s")


def _matching(pattern: str) -> re.Pattern[str]:
    parts = PLACEHOLDER.split(pattern)
    texts = map(re.escape, parts[::2])
    names = [f"(?P<{name}>{'[^;]+?' if name in EXPRESSIONS else '[^ ,;]+'})" for name in parts[1::2]] + [""]
    return re.compile("".join(text + name for text, name in zip(texts, names, strict=True)))


MATCHING = {pattern: _matching(pattern) for pattern in REASONS}


def translatable_reason(text: str) -> str:
    """Return a reason of Maxima's as a `Message` with its values, if it is known.

    Parameters
    ----------
    text : str
        Reason, in English.

    Returns
    -------
    str
        The same text. Any other than the known ones as it is.
    """
    for pattern, matching in MATCHING.items():
        if found := matching.fullmatch(text):
            return Message(pattern, **found.groupdict())
    return text
