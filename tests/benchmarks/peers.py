"""Who derives the chain: Holonom and its peers. What each derives becomes a motion program, counted and compiled alike.

A peer does what its own manual recommends: SymPy's LagrangesMethod with common-subexpression elimination; SymEngine
the Schur complement G = J A^-1 J^T with its LDL^T; CasADi the same, sparse, in its SX graphs; Maxima `invert` of G, and
`linsolve` of all equations at once.
"""

import json
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

import chain
import sympy as sp
from charged import charged

from holonom.expression.mathjson import from_sympy
from holonom.maxima import run_batch
from holonom.program.forms import MotionProgram
from holonom.program.motion_program import Program, read_program
from holonom.program.request import Request
from holonom.sandbox import Limits

EXAMPLE = Path(__file__).parents[2] / "examples" / "chain.mac"

OPENING = """
load("holonom.mac")$
open_namespace()$
"""
EQUATIONS = """
scalarmatrixp : false$
q : create_list(concat(axis, k), k, makelist(k, k, links), axis, ['x, 'y])$
v : map('dot, q)$
steps : makelist([q[2*k + 1] - (if k = 0 then 0 else q[2*k - 1]), q[2*k + 2] - (if k = 0 then 0 else q[2*k])],
                 k, 0, links - 1)$
f : makelist((d . d - 1)/2, d, steps)$
f[1] : (steps[1] . steps[1] - u^2)/2$
rate(e) := v . map(lambda([s], diff(e, s)), q) + dot(u)*diff(e, u) + ddot(u)*diff(e, dot(u))$
J : apply('matrix, makelist(map(lambda([s], diff(e, s)), q), e, f))$
c : map(lambda([e], rate(rate(e))), f)$
h : flatten(makelist([0, -981/100], k, links))$
"""
INVERT = """
multipliers : list_matrix_entries(invert(J . transpose(J)) . (-(c + list_matrix_entries(J . h))))$
accelerations : h + list_matrix_entries(multipliers . J)$
"""
LINSOLVE = """
unknown_a : map('ddot, q)$  unknown_l : makelist(multiplier(k), k, links)$
solution : map('rhs, linsolve(
  append(unknown_a - h - list_matrix_entries(unknown_l . J), list_matrix_entries(J . unknown_a) + c),
  append(unknown_a, unknown_l)))$
accelerations : rest(solution, -links)$  multipliers : rest(solution, 2*links)$
"""
WRITER = """
write_results(file) := write_json(
  apply('json_array, map('json_expression, append(accelerations, multipliers))), file)$
"""


def lagranges_method(links: int, seconds: float) -> Program:
    """SymPy: LagrangesMethod, rhs(), cse."""
    from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols

    del seconds
    t = dynamicsymbols._t
    coordinates, velocities, _ = chain.names(links)
    q, u = dynamicsymbols(" ".join(coordinates)), dynamicsymbols("u")
    gravity = sp.Rational(chain.GRAVITY)
    lagrangian = sum(qs.diff(t) ** 2 for qs in q) / 2 - gravity * sum(q[1::2])
    method = LagrangesMethod(lagrangian, q, hol_coneqs=chain.constraints(q, u))
    method.form_lagranges_equations()
    rates = method.rhs()[len(q) :]
    plain = {
        u.diff(t, 2): sp.Symbol("ddot(u)", real=True),
        u.diff(t): sp.Symbol("dot(u)", real=True),
        **{qs.diff(t): sp.Symbol(name, real=True) for qs, name in zip(q, velocities, strict=True)},
    }
    plain |= {qs: sp.Symbol(name, real=True) for qs, name in zip(q, coordinates, strict=True)}
    plain[u] = sp.Symbol("u", real=True)
    names = sp.numbered_symbols("w", real=True)
    shared, results = sp.cse([rate.xreplace(plain) for rate in rates], symbols=names)
    return _shared("LagrangesMethod", links, shared, results)


def symengine(links: int, seconds: float) -> Program:
    """SymEngine: J, the Schur complement, LDL^T, cse."""
    import symengine as se

    del seconds
    coordinates, velocities, _ = chain.names(links)
    q, v = ([se.Symbol(name) for name in names] for names in (coordinates, velocities))
    u, du, ddu = (se.Symbol(name) for name in ("u", "dot(u)", "ddot(u)"))
    rates = dict(zip([*q, u, du], [*v, du, ddu], strict=True))

    def rate(expression: object) -> object:
        return sum((expression.diff(s) * rates[s] for s in expression.free_symbols & rates.keys()), se.Integer(0))

    f = [se.sympify(constraint) for constraint in chain.constraints(q, u)]
    jacobian = se.DenseMatrix([[constraint.diff(qs) for qs in q] for constraint in f])
    applied = se.DenseMatrix([[0], [-se.sympify(sp.Rational(chain.GRAVITY))]] * links)
    curvature = se.DenseMatrix([[rate(rate(constraint))] for constraint in f])
    multipliers = (jacobian * jacobian.T).solve(-(curvature + jacobian * applied), "LDL")
    accelerations = applied + jacobian.T * multipliers
    shared, results = se.cse([*accelerations, *multipliers])
    return _shared("SymEngine", links, [(_real(n), _real(e)) for n, e in shared], [_real(e) for e in results])


def casadi(links: int, seconds: float) -> Program:
    """CasADi: SX, the Schur complement, sparse LDL^T; its own C."""
    import casadi as ca
    from casadi_functions import chain_of

    del seconds
    inputs, results = chain_of(links)
    function = ca.Function("chain", [inputs], [results])
    return _program("CasADi", links, instructions(function, chain.inputs(links)))


def maxima_invert(links: int, seconds: float) -> Program:
    """Maxima: invert(G)."""
    return _plain_maxima("Maxima invert", links, seconds, INVERT)


def maxima_linsolve(links: int, seconds: float) -> Program:
    """Maxima: linsolve for accelerations and multipliers together."""
    return _plain_maxima("Maxima linsolve", links, seconds, LINSOLVE)


def holonom(links: int, seconds: float) -> Program:
    """Holonom: the motion program of the example."""
    request = Request(settings={"N": str(links)})
    return MotionProgram(EXAMPLE, request, Limits(seconds=seconds)).program


PEERS: dict[str, Callable[[int, float], Program]] = {
    "Holonom": holonom,
    "CasADi": casadi,
    "SymEngine": symengine,
    "SymPy LagrangesMethod": lagranges_method,
    "Maxima invert": maxima_invert,
    "Maxima linsolve": maxima_linsolve,
}


def _shared(method: str, links: int, shared: Sequence[tuple], results: Sequence[sp.Expr]) -> Program:
    """The program of a common-subexpression elimination."""
    assignments = [[str(name), charged(from_sympy(value))] for name, value in shared]
    assignments += [[f"out{index}", charged(from_sympy(value))] for index, value in enumerate(results)]
    return _program(method, links, assignments)


def _real(expression: object) -> sp.Expr:
    """A SymEngine expression in SymPy, with real symbols."""
    converted = sp.sympify(expression)
    return converted.xreplace({symbol: sp.Symbol(symbol.name, real=True) for symbol in converted.free_symbols})


def instructions(function: object, names: Sequence[str]) -> list[list]:
    """The assignments of a CasADi function of one vector to one vector, instruction by instruction.

    Parameters
    ----------
    function : casadi.Function
    names : sequence of str
        Of the numbers that it takes; those that it gives are out0, out1, ...
    """
    import casadi as ca

    heads = {
        ca.OP_ADD: lambda a, b: ["Add", a, b],
        ca.OP_SUB: lambda a, b: ["Subtract", a, b],
        ca.OP_MUL: lambda a, b: ["Multiply", a, b],
        ca.OP_DIV: lambda a, b: ["Divide", a, b],
        ca.OP_NEG: lambda a: ["Negate", a],
        ca.OP_SQ: lambda a: ["Power", a, 2],
        ca.OP_TWICE: lambda a: ["Multiply", 2, a],
        ca.OP_INV: lambda a: ["Divide", 1, a],
    }
    assignments: list[list] = []
    work: dict[int, object] = {}
    results: dict[int, object] = {}
    for index in range(function.n_instructions()):
        operation, target = function.instruction_id(index), function.instruction_output(index)
        source = function.instruction_input(index)
        if operation == ca.OP_INPUT:
            work[target[0]] = names[source[1]]
        elif operation == ca.OP_OUTPUT:
            results[target[1]] = work[source[0]]
        elif operation == ca.OP_CONST:
            work[target[0]] = {"num": repr(function.instruction_constant(index))}
        else:
            assignments.append([f"w{index}", heads[operation](*(work[register] for register in source))])
            work[target[0]] = f"w{index}"
    return assignments + [[f"out{index}", results[index]] for index in sorted(results)]


def _plain_maxima(method: str, links: int, seconds: float, solve: str) -> Program:
    """The program of expressions that plain Maxima has derived; Holonom's library only writes them down."""
    with tempfile.TemporaryDirectory() as directory:
        file = Path(directory, "chain.mac")
        file.write_text(f"{OPENING}links : {links}$\n{EQUATIONS}{solve}{WRITER}", encoding="utf-8")
        trees = json.loads(run_batch(file, "write_results", Limits(seconds=seconds)))
    return _program(method, links, [[f"out{index}", charged(tree)] for index, tree in enumerate(trees)])


def _program(method: str, links: int, assignments: Sequence[list]) -> Program:
    """A program whose last assignments, out0, out1, ..., are its outputs."""
    document = {
        "format": "holonom-program",
        "version": 2,
        "scene": None,
        "solve": "direct",
        "method": method,
        "redundant": [],
        "operations": 0,
        "inputs": chain.inputs(links),
        "assignments": assignments,
        "outputs": {name: f"out{index}" for index, name in enumerate(chain.outputs(links))},
    }
    return read_program(json.dumps(document))
