"""A scene's model as a Python module of differentiable CasADi functions of SX."""

from ...failures import ErrorKind, HolonomError
from ..identifiers import require_identifier
from ..model import Model
from ..model_functions import has_law, model_functions
from ..python_module import Package, module_text
from ..templates import filled, template

IN_SPAN = """\
def in_span(t):
    return if_else(logic_and(t >= {}, t <= {}), t, nan)"""
CASADI = Package(
    module="casadi",
    usage="They are CasADi's, made of SX, for columns of one point, with derivatives. A sign counts as constant.",
    imports="from casadi import SX, Function, if_else, logic_and, vertcat",
    in_span=IN_SPAN,
    support=template("casadi.py.txt"),
    renamed={"pow": "power"},
    own=frozenset({"square", "cube"}),
    differentiates=True,
)


def write_model(model: Model, name: str) -> str:
    """Write a model as a Python module that needs CasADi.

    Parameters
    ----------
    model : Model
    name : str
        Name with which the names of CasADi's functions begin.

    Returns
    -------
    str
        Source text.

    Raises
    ------
    HolonomError
        The control law has tables, or the name cannot begin a function's name.
    """
    require_identifier(name)
    if model.tables:
        raise HolonomError(ErrorKind.NO_TABLES, model.scene, "casadi")
    lengths = {"t": 1, "y": len(model.state), "u": len(model.histories), "p": len(model.parameters)}
    taken = {each.name: each.arguments for each in model_functions(model)}
    if has_law(model):
        taken["rhs"] = ("t", "y", "p")
    made = [
        f'{function} = _function("{name}_{function}", {function}, '
        f"{', '.join(f'{each}={lengths[each]}' for each in arguments)})"
        for function, arguments in taken.items()
    ]
    return module_text(model, name, CASADI, filled("casadi_functions.py.txt", functions="\n".join(made)))
