"""Exact number and values of equilibria of small polynomial equations.

The equations r(q, lambda) = 0 and f(q) = 0 are polynomials in coordinates and multipliers. An angle, which whole
turns do not change, is replaced by its sine and cosine, with c^2 + s^2 = 1, also in sums of angles. Numbers are exact,
a control not known to be rational is the decimal number that is written. From a Groebner basis over the rational
numbers follow:

- There are finitely many complex solutions if and only if a power of each unknown is a leading monomial (Cox, Little &
  O'Shea, Ideals, Varieties, and Algorithms, section 5.3, theorem 6).
- The number of distinct real solutions is then the signature of Hermite's form, H_ij = trace of the multiplication by
  b_i b_j, with b the monomials that no leading monomial divides (Cox, Little & O'Shea, Using Algebraic Geometry,
  section 2.5, theorem 5.2).
- Multipliers of independent constraints suffice if their gradients have full rank wherever f = 0, and the others depend
  on them there: the maximal minors have no common zero if 1 is in their ideal with f (Cox, Little & O'Shea, Ideals,
  Varieties, and Algorithms, section 4.1, theorem 1), and those with one more row vanish if they are in that of f.
- With a polynomial g in it, the trace of the multiplication by g b_i b_j, its signature is the number of solutions with
  g > 0 less that with g < 0. These differences for all products of several g count the solutions with given signs
  (Basu, Pollack & Roy, Algorithms in Real Algebraic Geometry, sections 4.6 and 2.3).
- The values of an unknown are roots of the characteristic polynomial of the multiplication by it (section 2.4, theorem
  4.5 of the same book). The numeric solution chooses one of them.
- The values of the monomials b at a solution are an eigenvector of the multiplication by any polynomial (section 2.4,
  the same). With rounding errors, they are starting points.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction
from functools import cached_property
from itertools import chain, combinations, pairwise, product
from math import comb, prod
from typing import Any

import numpy as np
import sympy
from sympy.polys.domains import QQ
from sympy.polys.groebnertools import groebner
from sympy.polys.matrices import DomainMatrix
from sympy.polys.orderings import grevlex
from sympy.polys.rings import PolyElement, PolyRing, ring

from ..program.arithmetic import Arithmetic, run_program
from ..program.motion_problem import DOUBLE_DIGITS
from ..program.motion_program import Constant, Operation, names_used
from ..program.rewriting import computing
from .linear_equations import LinearEquations

UNKNOWNS = 10  # larger systems are not tried
SOLUTIONS = 64  # larger products of the degrees, Bezout's bound of the number of complex solutions, are not tried
EXACT = 16  # with more complex solutions, values stay numeric
NEAR = 1e-9  # relative distance of a numeric value from the exact one
UNDEFINED = object()  # the value of an expression that is not a polynomial
MIXED = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29)  # an unknown each: the sum distinguishes most solutions
TIMES = 8  # with larger multiples of an angle, degrees are too large


@dataclass(frozen=True)
class RealSolutions:
    """The states at rest for constant controls.

    Attributes
    ----------
    count : int
        Number of distinct real solutions in coordinates and multipliers, up to whole turns of angles, with the given
        orientation.
    regular : bool
        Whether the gradients of the independent constraints are known to be independent wherever these hold. Elsewhere
        a system may be at rest without multipliers that balance its forces.
    """

    count: int
    regular: bool
    _basis: Sequence[PolyElement] = field(repr=False)
    _standard: Sequence[tuple[int, ...]] = field(repr=False)

    def approximate(self, coordinates: Sequence[str]) -> list[list[float]]:
        """Return numbers near the real solutions, and perhaps others.

        Multiple solutions have large errors.

        Parameters
        ----------
        coordinates : sequence of str
            Names of the coordinates.

        Returns
        -------
        list of list of float
            Values of the coordinates.
        """
        ring = self._basis[0].ring
        if not self._standard:
            return []
        mixed = sum((unknown * prime for unknown, prime in zip(ring.gens, MIXED, strict=False)), ring.zero)
        try:
            columns = np.linalg.eig(self._multiplication(mixed))[1].T
            unknowns = np.array([[float(c) for c in self._coefficients(x)] for x in ring.gens])
        except OverflowError:  # coefficients beyond double precision
            return []
        one = np.array([float(c) for c in self._coefficients(ring.one)])
        with np.errstate(all="ignore"):
            values = [unknowns @ each / (one @ each) for each in columns]
        names = list(map(str, ring.symbols))
        real = [dict(zip(names, each.real, strict=True)) for each in values if np.isfinite(each).all()]
        return [[_angle_or_value(name, each) for name in coordinates] for each in real]

    def _coefficients(self, polynomial: PolyElement) -> list[Any]:
        """Return coefficients of the standard monomials in a polynomial's remainder."""
        left = polynomial.rem(self._basis)
        return [left.get(m, QQ.zero) for m in self._standard]

    def _multiplication(self, polynomial: PolyElement) -> np.ndarray:
        monomials = [polynomial.ring({m: QQ.one}) for m in self._standard]
        return np.array([[float(c) for c in self._coefficients(polynomial * each)] for each in monomials])

    def exact(self, values: Mapping[str, float]) -> dict[str, sympy.Expr]:
        """Return the exact values of a solution, as far as they are known.

        Parameters
        ----------
        values : mapping of str to float
            Numeric values of its coordinates and multipliers.

        Returns
        -------
        dict of str to SymPy expression
            Rational numbers, square roots, or roots of irreducible polynomials (``CRootOf``), and arc cosines of
            these for angles. Empty if the equations are large.
        """
        found = {name: self._exact(name, value) for name, value in values.items()}
        return {name: value for name, value in found.items() if value is not None}

    def _exact(self, name: str, value: float) -> sympy.Expr | None:
        if name in self._roots:
            return _nearest(self._roots[name], value)
        cosine = _nearest(self._roots.get(f"cos({name})", ()), math.cos(value))
        return None if cosine is None else sympy.acos(cosine) * (-1 if math.sin(value) < -NEAR else 1)

    @cached_property
    def _roots(self) -> Mapping[str, Sequence[sympy.Expr]]:
        """Real values that each unknown may have."""
        if len(self._standard) > EXACT:
            return {}
        ring = self._basis[0].ring
        return {str(name): self._values(unknown) for name, unknown in zip(ring.symbols, ring.gens, strict=True)}

    def _values(self, unknown: PolyElement) -> list[sympy.Expr]:
        rows = [self._coefficients(unknown * unknown.ring({m: QQ.one})) for m in self._standard]
        coefficients = DomainMatrix(rows, (len(rows), len(rows)), QQ).charpoly()
        _, factors = sympy.Poly(coefficients, sympy.Dummy(), domain=QQ).factor_list()
        return [root for each, _ in factors for root in _real_roots(each)]


def _angle_or_value(name: str, values: Mapping[str, float]) -> float:
    if name in values:
        return float(values[name])
    return math.atan2(values.get(f"sin({name})", 0.0), values.get(f"cos({name})", 1.0))


def _nearest(roots: Sequence[sympy.Expr], value: float) -> sympy.Expr | None:
    """Return the root that is near a value, and farther from the other roots, or None."""
    numbers = [float(root.evalf()) for root in roots]
    if not numbers:
        return None
    nearest = min(range(len(numbers)), key=lambda place: abs(numbers[place] - value))
    found = numbers[nearest]
    gap = min((abs(other - found) for other in numbers[:nearest] + numbers[nearest + 1 :]), default=math.inf)
    apart = abs(found - value)
    return roots[nearest] if apart <= NEAR * max(abs(found), gap) and apart < gap / 4 else None


def _real_roots(polynomial: sympy.Poly) -> list[sympy.Expr]:
    """Return the real roots of an irreducible polynomial, in square roots if possible."""
    radicals = sympy.roots(polynomial, cubics=False, quartics=False, quintics=False, multiple=True)
    if len(radicals) < polynomial.degree():
        return polynomial.real_roots()
    numbers = [root.evalf(30) for root in radicals]
    return [root for root, number in zip(radicals, numbers, strict=True) if abs(sympy.im(number)) <= NEAR * abs(number)]


def solve_exactly(
    equations: LinearEquations,
    independent: Sequence[int],
    controls: Sequence[Fraction],
    turns: Sequence[str],
    orientation: Sequence[int],
) -> RealSolutions | None:
    """Count the states at rest for constant controls.

    Parameters
    ----------
    equations : LinearEquations
        Of the scene.
    independent : sequence of int
        Indices of independent constraints, counted from 0. The multipliers of the others are zero.
    controls : sequence of Fraction
        Constant values, in the order of the equations.
    turns : sequence of str
        Coordinates that whole turns do not change.
    orientation : sequence of int
        Sign of each of the equations' orientations.

    Returns
    -------
    RealSolutions or None
        None if the equations are not polynomial, or too large, or have infinitely many complex solutions, or if the
        constraints taken for independent are not known to be so at all states: others have other solutions there.
    """
    others = [beta for beta in range(len(equations.multipliers)) if beta not in independent]
    rest, constraints, gradients, orientations = _polynomials(equations, independent, controls, turns)
    polynomials = [*rest, *constraints]
    if not polynomials or not _are_small(polynomials):
        return None
    if any(g is UNDEFINED for g in orientations):
        return None
    if others and not _replaceable(others, independent, constraints, gradients):
        return None
    basis = groebner(polynomials, polynomials[0].ring)
    standard = _standard_monomials(basis)
    if standard is None:
        return None
    regular = _are_regular([gradients[beta] for beta in independent], constraints)
    count = _count_with_signs(basis, standard, list(zip(orientations, orientation, strict=True)))
    return RealSolutions(count, regular, basis, standard)


def rational_controls(equations: LinearEquations, t: str) -> dict[str, Fraction]:
    """Return the controls that are known to be rational at a time.

    Parameters
    ----------
    equations : LinearEquations
        Of the scene.
    t : str
        The time in decimal digits. In as many as a double has, it may be rounded, and is not known.

    Returns
    -------
    dict of str to Fraction
        By name, without those whose law has other functions than polynomials.
    """
    if equations.law is None:
        return {}
    program, (polynomials, _) = computing(equations.law, set(equations.controls)), ring("t", QQ, grevlex)
    inputs = dict.fromkeys(program.inputs, UNDEFINED)
    if len(Decimal(t).normalize().as_tuple().digits) < DOUBLE_DIGITS:
        inputs["t"] = polynomials(QQ(*Fraction(t).as_integer_ratio()))
    found = run_program(program, inputs, _arithmetic(polynomials))
    numbers = {name: QQ(value.coeff(1)) for name, value in found.items() if value is not UNDEFINED}
    return {name: Fraction(int(each.numerator), int(each.denominator)) for name, each in numbers.items()}


def _are_small(polynomials: Sequence[Any]) -> bool:
    if any(each is UNDEFINED for each in polynomials):
        return False
    return prod(max(map(sum, each.itermonoms())) for each in polynomials) <= SOLUTIONS


def _are_regular(gradients: Sequence[Sequence[Any]], constraints: Sequence[PolyElement]) -> bool:
    """Return True if gradients are independent wherever f = 0.

    Their minors have no real zero there. False also if that is not known.
    """
    if not gradients:
        return True
    too_many = comb(len(gradients[0]), len(gradients)) > SOLUTIONS
    if too_many or any(each is UNDEFINED for row in gradients for each in row):
        return False
    ring = gradients[0][0].ring
    basis = groebner([*constraints, *_minors(gradients, ring)], ring)
    standard = _standard_monomials(basis)
    return standard is not None and _count_real_zeros(basis, standard) == 0


def _replaceable(
    others: Sequence[int],
    independent: Sequence[int],
    constraints: Sequence[PolyElement],
    gradients: Sequence[Sequence[Any]],
) -> bool:
    """Return True if gradients depend on independent ones wherever f = 0.

    The minors of these have no common zero there, and with one more all minors vanish. False also if that is not known.
    """
    n = len(gradients[0])
    if comb(n, len(independent)) > SOLUTIONS or any(each is UNDEFINED for row in gradients for each in row):
        return False
    chosen, ring = [gradients[beta] for beta in independent], gradients[0][0].ring
    basis = groebner(constraints, ring)
    return groebner([*constraints, *_minors(chosen, ring)], ring) == [ring.one] and not any(
        minor.rem(basis) for beta in others for minor in _minors([*chosen, gradients[beta]], ring)
    )


def _minors(rows: Sequence[Sequence[PolyElement]], ring: PolyRing) -> list[PolyElement]:
    """Return the largest minors that are not zero identically, but for their signs."""
    squares = ([[row[k] for k in columns] for row in rows] for columns in combinations(range(len(rows[0])), len(rows)))
    found = (DomainMatrix(each, (len(rows), len(rows)), ring.to_domain()).charpoly()[-1] for each in squares)
    return [each for each in found if each]


def _polynomials(
    equations: LinearEquations, independent: Sequence[int], controls: Sequence[Fraction], turns: Sequence[str]
) -> tuple[list[Any], list[Any], list[list[Any]], list[Any]]:
    """Return r and f at rest, the gradients of f and the orientations.

    Zeros are left out of r and f. What is not a polynomial is `UNDEFINED`.
    """
    n, g = len(equations.coordinates), len(equations.multipliers)
    forces = [f"equation[{k}]" for k in range(1, n + 1)]
    constraints = [f"constraint[{beta}]" for beta in range(1, g + 1)]
    gradients = [[f"constraint_by_q[{beta},{k}]" for k in range(1, n + 1)] for beta in range(1, g + 1)]
    program = computing(equations.program, {*forces, *constraints, *chain(*gradients)})
    angles = [name for name in turns if name in names_used(program)]
    plain = [
        *(name for name in equations.coordinates if name not in angles),
        *(equations.multipliers[k] for k in independent),
    ]
    unknowns = [*plain, *(f"{kind}({name})" for name in angles for kind in ("cos", "sin"))]
    if not 0 < len(unknowns) <= UNKNOWNS:
        return [], [], [], []
    with_angles, *generators = ring([*unknowns, *angles], QQ, grevlex)
    polynomials, *few = ring(unknowns, QQ, grevlex)
    arithmetic, unknown = _arithmetic(with_angles), dict(zip(unknowns, few, strict=True))
    inputs = dict.fromkeys(program.inputs, with_angles.zero)
    inputs |= dict(zip([*unknowns, *angles], generators, strict=True))
    values = (with_angles(QQ(value.numerator, value.denominator)) for value in controls)
    inputs |= dict(zip(equations.controls, values, strict=True))
    oriented = equations.orientations
    found = {
        name: _without_last(value, polynomials)
        for each in (program, *([] if oriented is None else [oriented]))
        for name, value in run_program(each, inputs, arithmetic).items()
    }
    circles = [unknown[f"cos({name})"] ** 2 + unknown[f"sin({name})"] ** 2 - 1 for name in angles]
    return (
        [found[name] for name in forces if found.get(name)],
        [found[name] for name in constraints if found.get(name)] + circles,
        [[found.get(name, polynomials.zero) for name in row] for row in gradients],
        [] if oriented is None else [found[name] for name in oriented.outputs],
    )


def _without_last(value: Any, polynomials: PolyRing) -> Any:
    """Return a polynomial in the first unknowns alone, undefined if others occur."""
    if value is UNDEFINED or any(any(monomial[polynomials.ngens :]) for monomial in value.itermonoms()):
        return UNDEFINED
    return polynomials({monomial[: polynomials.ngens]: number for monomial, number in value.iterterms()})


def _arithmetic(polynomials: PolyRing) -> Arithmetic[Any]:
    """Return the arithmetic of a ring.

    A product with zero is zero. Sines and cosines are unknowns, or sums of products of them by the addition theorems.
    Other operations than those of the ring are undefined.
    """
    unknowns = dict(zip(map(str, polynomials.symbols), polynomials.gens, strict=True))

    def number(value: Fraction) -> PolyElement:
        return polynomials(QQ(value.numerator, value.denominator))

    def total(*terms: Any) -> Any:
        return UNDEFINED if any(term is UNDEFINED for term in terms) else sum(terms, polynomials.zero)

    def multiplied(*factors: Any) -> Any:
        if any(factor is not UNDEFINED and not factor for factor in factors):
            return polynomials.zero
        return UNDEFINED if any(factor is UNDEFINED for factor in factors) else prod(factors, start=polynomials.one)

    def negated(value: Any) -> Any:
        return multiplied(-polynomials.one, value)

    def divided(numerator: Any, denominator: Any) -> Any:
        constant = denominator is not UNDEFINED and denominator and denominator.is_ground
        return multiplied(numerator, polynomials(1 / denominator.coeff(1)) if constant else UNDEFINED)

    def power(base: Any, exponent: Fraction) -> Any:
        if base is UNDEFINED or exponent.denominator != 1:
            return UNDEFINED
        return base ** int(exponent) if exponent >= 0 else divided(polynomials.one, base ** int(-exponent))

    def cosine_and_sine(argument: Any) -> tuple[Any, Any]:
        cosine, sine = polynomials.one, polynomials.zero
        for monomial, times in argument.iterterms():
            name = str(polynomials.symbols[monomial.index(max(monomial))])
            if sum(monomial) != 1 or f"cos({name})" not in unknowns or times.denominator != 1 or abs(times) > TIMES:
                return UNDEFINED, UNDEFINED
            c, s = unknowns[f"cos({name})"], unknowns[f"sin({name})"] * (1 if times > 0 else -1)
            for _ in range(abs(int(times))):
                cosine, sine = cosine * c - sine * s, sine * c + cosine * s
        return cosine, sine

    known = {
        Operation.COS: lambda x: UNDEFINED if x is UNDEFINED else cosine_and_sine(x)[0],
        Operation.SIN: lambda x: UNDEFINED if x is UNDEFINED else cosine_and_sine(x)[1],
        Operation.ADD: total,
        Operation.MULTIPLY: multiplied,
        Operation.SUBTRACT: lambda x, y: total(x, negated(y)),
        Operation.DIVIDE: divided,
        Operation.NEGATE: negated,
    }
    others = {operation: lambda *_: UNDEFINED for operation in Operation if operation not in known}
    return Arithmetic(number, dict.fromkeys(Constant, UNDEFINED), power, known | others)


def _standard_monomials(basis: Sequence[PolyElement]) -> list[tuple[int, ...]] | None:
    """Return the monomials that no leading monomial of a Groebner basis divides.

    None if there are infinitely many, or more than `SOLUTIONS`.
    """
    leading = [each.LM for each in basis]
    powers = [[m[k] for m in leading if m[k] == sum(m)] for k in range(basis[0].ring.ngens)]
    if not all(powers):
        return None

    def divides(lead: tuple[int, ...], monomial: tuple[int, ...]) -> bool:
        return all(a <= b for a, b in zip(lead, monomial, strict=True))

    outside = product(*(range(min(each)) for each in powers))
    standard = [m for m in outside if not any(divides(lead, m) for lead in leading)]
    return standard if len(standard) <= SOLUTIONS else None


def _count_with_signs(
    basis: Sequence[PolyElement], standard: Sequence[tuple[int, ...]], signed: Sequence[tuple[PolyElement, int]]
) -> int:
    """Count the distinct real zeros at which each polynomial has its sign."""
    one = basis[0].ring.one
    subsets = product(*([(one, 1), (g, sign)] for g, sign in signed))
    weighted = ((prod((g for g, _ in some), start=one), prod(sign for _, sign in some)) for some in subsets)
    return sum(sign * _signature(basis, standard, weight) for weight, sign in weighted) >> len(signed)


def _count_real_zeros(basis: Sequence[PolyElement], standard: Sequence[tuple[int, ...]]) -> int:
    """Count the distinct real zeros of a Groebner basis."""
    return _signature(basis, standard, basis[0].ring.one)


def _signature(basis: Sequence[PolyElement], standard: Sequence[tuple[int, ...]], weight: PolyElement) -> int:
    """Return the signature of Hermite's form with a weight."""
    monomials = [basis[0].ring({m: QQ.one}) for m in standard]
    products = [[(a * b).rem(basis) for b in monomials] for a in monomials]
    traces = {
        m: sum((each.get(n, QQ.zero) for n, each in zip(standard, row, strict=True)), QQ.zero)
        for m, row in zip(standard, products, strict=True)
    }
    weighted = [[(weight * each).rem(basis) for each in row] for row in products]
    form = [[sum((c * traces[m] for m, c in each.iterterms()), QQ.zero) for each in row] for row in weighted]
    coefficients = DomainMatrix(form, (len(form), len(form)), QQ).charpoly()
    mirrored = [-c if k % 2 else c for k, c in enumerate(coefficients)]
    return _sign_changes(coefficients) - _sign_changes(mirrored)


def _sign_changes(coefficients: Sequence[Any]) -> int:
    """Count changes of sign.

    If all roots are real, this is the number of positive roots (Descartes).
    """
    return sum((a > 0) != (b > 0) for a, b in pairwise([c for c in coefficients if c]))
