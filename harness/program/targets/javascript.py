"""A motion program as JavaScript, for a page or for Node, with the formulas of C."""

import json
from collections.abc import Iterable

from ..c_source import FUNCTIONS, IN_SPAN, ONE, Target, comment_text, statements, title_of
from ..identifiers import require_identifier
from ..model_functions import called
from ..motion_program import Operation, Program
from ..templates import filled

SCRIPT = Target("const {name} = {formula};", ONE.arithmetic)
NAMES_IN_MATH = {Operation.ABS: "abs: fabs"}  # where C and Math differ
DEFINED_IN_SPAN = "\n  const in_span = t => t >= {} && t <= {} ? t : NaN;"
MISSING_IN_MATH = {Operation.ERF}


def write(program: Program, name: str = "motion") -> str:
    """Write a program as JavaScript, for a page or for Node.

    Parameters
    ----------
    program : Program
    name : str
        Name of the constant.

    Returns
    -------
    str
        A classic script that defines a constant with ``inputs``, ``outputs`` and ``evaluate``.

    Raises
    ------
    HolonomError
        The name cannot name a constant.
    """
    require_identifier(name)
    reads = [f"values[{place}]" for place in range(len(program.inputs))]
    writes = [f"results[{place}] = {{value}};" for place in range(len(program.outputs))]
    body = "\n".join(f"    {line}" for line in statements(program, SCRIPT, reads, writes))
    return filled(
        "motion.js",
        title=comment_text(title_of(program)),
        name=name,
        in_span=DEFINED_IN_SPAN.format(*program.times) if IN_SPAN in called(body) else "",
        functions=", ".join(
            NAMES_IN_MATH.get(operation, function)
            for operation, function in FUNCTIONS.items()
            if operation not in MISSING_IN_MATH
        ),
        inputs=_listed(program.inputs),
        outputs=_listed(program.outputs),
        count=len(program.outputs),
        body=body,
    )


def _listed(names: Iterable[str]) -> str:
    """Return the names as an array of strings that cannot end a script element."""
    return json.dumps(list(names)).replace("</", "<\\/")
