"""A motion program as JavaScript, for a page or for Node: the formulas are those of C, whose functions Math has too."""

import json
from collections.abc import Iterable

from ..failures import Failure, HolonomError
from .c_source import FUNCTIONS, IDENTIFIER, ONE, Target, comment_text, statements, title_of
from .motion_program import Operation, Program

SCRIPT = Target("const", ONE.arithmetic)
NAMES_IN_MATH = {Operation.ABS: "abs: fabs"}  # where C and Math differ
MISSING_IN_MATH = {Operation.ERF}

SOURCE = """\
/* {title} */
"use strict";

const {name} = (() => {{
  const {{{functions}, pow}} = Math;
  const square = x => x*x, cube = x => x*x*x;
  const erf = x => {{  // exp(-x^2) times the series of positive terms; 1 to rounding beyond 6
    if (fabs(x) > 6) return sign(x);
    let term = x, sum = x;
    for (let n = 1; fabs(term) > 1e-17*fabs(sum); n++) sum += term *= 2*x*x/(2*n + 1);
    return 2/sqrt(Math.PI)*exp(-x*x)*sum;
  }};
  const inputs = {inputs};
  const outputs = {outputs};

  /* Takes the values of inputs, returns those of outputs. */
  function evaluate(values) {{
    const results = new Array({count});
{body}
    return results;
  }}
  return {{inputs, outputs, evaluate}};
}})();

if (typeof module === "object") module.exports = {name};
"""


def javascript_source(program: Program, name: str = "motion") -> str:
    """Write a program as JavaScript.

    A classic script, which Node can require too: a constant of that name with `inputs`, `outputs` and ``evaluate``.

    Raises
    ------
    HolonomError
        The name cannot name a constant.
    """
    if not IDENTIFIER.fullmatch(name):
        raise HolonomError(Failure.NOT_AN_IDENTIFIER, detail=name)
    reads = [f"values[{place}]" for place in range(len(program.inputs))]
    writes = [f"results[{place}] = {{value}};" for place in range(len(program.outputs))]
    return SOURCE.format(
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
    """The names as an array of strings, in which nothing can end a script element."""
    return json.dumps(list(names)).replace("</", "<\\/")
