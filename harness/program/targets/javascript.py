"""A motion program as JavaScript, for a page or for Node: the formulas are those of C, whose functions Math has too."""

import json
from collections.abc import Iterable

from ..c_source import FUNCTIONS, ONE, Target, comment_text, statements, title_of
from ..identifiers import require_identifier
from ..motion_program import Operation, Program
from ..templates import filled

SCRIPT = Target("const", ONE.arithmetic)
NAMES_IN_MATH = {Operation.ABS: "abs: fabs"}  # where C and Math differ
MISSING_IN_MATH = {Operation.ERF}


def write(program: Program, name: str = "motion") -> str:
    """Write a program as JavaScript.

    A classic script, which Node can require too: a constant of that name with `inputs`, `outputs` and ``evaluate``.

    Raises
    ------
    HolonomError
        The name cannot name a constant.
    """
    require_identifier(name)
    reads = [f"values[{place}]" for place in range(len(program.inputs))]
    writes = [f"results[{place}] = {{value}};" for place in range(len(program.outputs))]
    return filled(
        "motion.js",
        title=comment_text(title_of(program)),
        name=name,
        functions=", ".join(
            NAMES_IN_MATH.get(operation, function)
            for operation, function in FUNCTIONS.items()
            if operation not in MISSING_IN_MATH
        ),
        inputs=_listed(program.inputs),
        outputs=_listed(program.outputs),
        count=len(program.outputs),
        body="\n".join(f"    {line}" for line in statements(program, SCRIPT, reads, writes)),
    )


def _listed(names: Iterable[str]) -> str:
    """Return the names as an array of strings, in which nothing can end a script element."""
    return json.dumps(list(names)).replace("</", "<\\/")
