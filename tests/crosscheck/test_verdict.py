"""The verdicts, and what each rests on."""

import dataclasses
import re

import pytest
import sympy as sp
from systems import symbols

from holonom.crosscheck.digits import DIGITS, POINTS
from holonom.crosscheck.linear import LinearEquations
from holonom.crosscheck.report import Verdict
from holonom.crosscheck.verdict import ATTEMPTS, Comparison, Pair, verify

X, Y, Z = symbols("x y z")


def compared(derived: sp.Expr, independent: sp.Expr) -> Comparison:
    return Comparison((Pair("something", sp.sympify(derived), sp.sympify(independent)),))


def test_identity_is_proved() -> None:
    found = verify(compared((X + Y) ** 2, X**2 + 2 * X * Y + Y**2), "seed")
    assert (found.verdict, found.digits, found.points) == (Verdict.PROVED, DIGITS, POINTS)


def test_identity_that_the_normal_form_does_not_know_agrees() -> None:
    assert verify(compared(sp.log(X**2 * Y**2), sp.log(X**2) + sp.log(Y**2)), "seed").verdict is (Verdict.AGREES)


def test_rounding_of_large_terms_that_cancel_was_a_disagreement() -> None:
    angles = sp.asin(X / 3) + sp.acos(X / 3)  # the normal form does not know their sum
    assert verify(compared(sp.Integer(0), 10**60 * (2 * angles - sp.pi)), "seed").verdict is Verdict.AGREES
    found = verify(compared(sp.Integer(0), 10**60 * (2 * angles - sp.pi) + sp.Rational(1, 10**40)), "seed")
    assert found.verdict is Verdict.DISAGREES
    assert "1.0e-40" in found.detail


@pytest.mark.parametrize("power", [sp.Rational(1, 3), sp.Rational(1, 2), -1])
def test_rounding_that_shrinks_slowly_is_no_difference_and_one_that_grows_is(power) -> None:
    """A root of a rounding error gains a share of the digits only; its reciprocal has no value, and zero has one."""
    hidden = sp.Abs(2 * sp.asin(X / 3) + 2 * sp.acos(X / 3) - sp.pi) ** power
    expected = Verdict.UNDECIDED if power > 0 else Verdict.DISAGREES
    found = verify(compared(hidden, sp.Integer(0)), "seed")
    assert (found.verdict, found.points) == (expected, None if power > 0 else ATTEMPTS * POINTS)
    assert (
        verify(compared(hidden * (1 + sp.sign(X - sp.Rational(1, 2))), sp.Integer(0)), "seed").verdict
        is Verdict.UNDECIDED
    )


def test_a_root_of_what_is_zero_up_to_rounding_was_an_internal_error() -> None:
    """Real numbers among complex ones that were compared by size; of a square root of zero nothing is proved."""
    hidden = 2 * sp.asin(X / 3) + 2 * sp.acos(X / 3) - sp.pi
    assert verify(compared(sp.sqrt(hidden), sp.Integer(0)), "seed").verdict is not Verdict.PROVED


def test_difference_beyond_double_precision_is_found() -> None:
    found = verify(compared(X + sp.Rational(1, 10**40), X), "seed")
    assert found.verdict is Verdict.DISAGREES
    derived, known = re.findall(r"\d\.\d+\S*(?=,| at )", found.detail)
    assert derived != known


def test_a_decimal_is_the_fraction_that_it_is() -> None:
    assert verify(compared(sp.Float(0.5) * X, X / 2), "seed").verdict is not Verdict.DISAGREES
    assert verify(compared(sp.Float(0.1) * X, X / 10), "seed").verdict is Verdict.DISAGREES


def test_points_where_an_expression_is_not_real_are_passed_over() -> None:
    assert verify(compared(sp.sqrt(X) ** 3, X * sp.sqrt(X)), "seed").verdict is Verdict.PROVED


def test_nothing_is_decided_where_no_point_is_regular() -> None:
    imaginary = sp.sqrt(-1 - X**2)
    found = verify(compared(imaginary, imaginary), "seed")
    assert found[:3] == (Verdict.UNDECIDED, None, None)


def test_a_domain_that_random_points_miss_is_found() -> None:
    far = sp.sqrt(X - 10**5)
    assert verify(compared(far, 2 * far), "seed").verdict is Verdict.DISAGREES
    assert verify(compared(far**3, far * (X - 10**5)), "seed").verdict is Verdict.PROVED


@pytest.mark.parametrize("valueless", [sp.sqrt(-1 - X**2), sp.zoo * X])
def test_what_has_no_value_where_the_truth_has_one_disagrees(valueless) -> None:
    found = verify(compared(valueless, X), "seed")
    assert found.verdict is Verdict.DISAGREES


def test_a_difference_counts_although_other_points_are_irregular() -> None:
    assert verify(compared(sp.sqrt(X) + 1, sp.sqrt(X)), "seed").verdict is Verdict.DISAGREES


def test_a_constant_is_compared_once() -> None:
    assert verify(compared(sp.sqrt(5) * sp.sqrt(5), sp.Integer(5)), "seed").points == 1


def test_solution_is_proved_by_its_certificate_alone() -> None:
    equations = LinearEquations((Y,), (Z * Y - X,))
    pairs = (Pair("y", X / Z, Y),)
    without = Comparison(pairs, solves=(equations,))
    assert verify(without, "seed").verdict is Verdict.AGREES
    assert verify(Comparison(pairs, solves=(equations,), certificate={Y: X / Z}), "seed").verdict is (Verdict.PROVED)
    wrong = Comparison(pairs, solves=(equations,), certificate={Y: Z / X})
    assert verify(wrong, "seed").verdict is Verdict.AGREES


def test_the_same_seed_gives_the_same_point() -> None:
    details = {verify(compared(X, Y), "seed").detail for _ in range(3)}
    assert len(details) == 1
    assert verify(compared(X, Y), "another").detail not in details


def test_a_verdict_on_nothing_was_called_proved():
    found = verify(Comparison(()), seed="(19)")
    assert (found.verdict, found.digits, found.points) == (Verdict.NOTHING, None, None)


def test_a_certificate_that_is_no_solution_proves_nothing() -> None:
    """Both unknowns doubled: what is compared vanishes all the same, the equations do not."""
    equations = LinearEquations((Y, Z), (Y - X, Z - X))
    comparison = Comparison((Pair("y - z", Y - Z, sp.Integer(0)),), solves=(equations,))
    for factor, expected in ((1, Verdict.PROVED), (2, Verdict.AGREES)):
        certified = dataclasses.replace(comparison, certificate={Y: factor * X, Z: factor * X})
        assert verify(certified, "seed").verdict is expected


def test_what_is_given_counts_at_the_points_and_in_the_proof() -> None:
    """Later ones use the ones before them."""
    given = {Y: X**2, Z: 1 + Y}
    assert verify(Comparison((Pair("z", Z, 1 + X**2),), given), "seed").verdict is Verdict.PROVED
    assert verify(Comparison((Pair("z", Z, 2 + X**2),), given), "seed").verdict is Verdict.DISAGREES


def test_what_is_given_counts_in_the_arguments_of_functions() -> None:
    """The normal form does not know the sum of the angles; exp(z) and exp(x y) are one function of one symbol."""
    angles = sp.asin(X / 3) + sp.acos(X / 3)
    for given, expected in (({Z: X * Y}, Verdict.AGREES), ({Z: 1 + X * Y}, Verdict.DISAGREES)):
        pair = Pair("product", sp.exp(Z) * angles, sp.exp(X * Y) * sp.pi / 2)
        assert verify(Comparison((pair,), given), "seed").verdict is expected


def test_the_last_pair_counts_as_much_as_the_first() -> None:
    pairs = (Pair("x", X, X), Pair("y", Y, Y), Pair("z", Z, Z + 1))
    assert verify(Comparison(pairs), "seed").verdict is Verdict.DISAGREES


def test_large_values_are_compared_by_their_own_size() -> None:
    large = sp.Integer(10) ** 30
    assert verify(compared(large * X, large * X + sp.Rational(1, 10**10)), "seed").verdict is Verdict.DISAGREES


def test_a_point_where_the_equations_are_singular_is_passed_over() -> None:
    """Drawn from the integers, the coefficient would vanish often; here at half of the points."""
    equations = LinearEquations((Y,), (sp.sign(X - 1) * Y + Y - 2 * X,))
    assert verify(Comparison((Pair("y", X, Y),), solves=(equations,)), "seed").verdict is Verdict.AGREES


LARGE = sp.Integer(10) ** 30


@pytest.mark.parametrize(
    ("derived", "independent"),
    [
        (3 - X, sp.Abs(X - 3)),
        (X - 10**8, sp.Abs(X - 10**8)),
        (sp.sqrt(X) * sp.sqrt(Y), sp.sqrt(X * Y)),
        (2 * sp.log(X), sp.log(X**2)),
        (sp.Integer(0), (X - 3 + sp.Abs(X - 3)) * (Y + sp.Abs(Y)) * (Z - 1 + sp.Abs(Z - 1))),
        (X, X + sp.exp(-(10**6) * (X - 1) ** 2)),
        (X, X + 1 - sp.tanh(10**9 * (X - 1)) ** 2),
        (LARGE * X, LARGE * X + Y / LARGE),
        (X / LARGE**2, 3 * X / LARGE**2),
    ],
    ids=str,
)
def test_a_difference_on_one_side_of_a_branch_or_in_a_narrow_range_is_found(derived, independent) -> None:
    for seed in ("first", "second", "third"):
        assert verify(compared(derived, independent), seed).verdict is Verdict.DISAGREES


def test_a_quotient_of_two_zeros_is_no_value() -> None:
    none = (sp.sin(X) ** 2 + sp.cos(X) ** 2 - 1) / (sp.sin(2 * X) - 2 * sp.sin(X) * sp.cos(X))
    assert verify(compared(X + none, X), "seed").verdict is Verdict.DISAGREES


def test_what_agrees_by_an_identity_of_the_arguments_agrees_at_points_alone() -> None:
    """exp(x y) is a function of the product, which the independent values of functions keep; log(exp(x) y) is not."""
    assert verify(compared(sp.Abs(X) * sp.exp(X + Y), sp.Abs(X) * sp.exp(X) * sp.exp(Y)), "seed").verdict is (
        Verdict.PROVED
    )
    assert verify(compared(sp.atan(X) + sp.atan(1 / X), sp.sign(X) * sp.pi / 2), "seed").verdict is Verdict.SAMPLED


def test_pairs_have_regular_points_of_their_own() -> None:
    """No point is regular for both of them."""
    pairs = (Pair("x", sp.sqrt(X), sp.sqrt(X)), Pair("-x", sp.sqrt(-X - 1), 2 * sp.sqrt(-X - 1)))
    assert verify(Comparison(pairs), "seed").verdict is Verdict.DISAGREES


def test_a_rounded_number_is_compared_to_fifty_digits() -> None:
    def verdict(digits: int) -> Verdict:
        rounded = {X: sp.Rational(int(sp.sqrt(2).n(80) * 10**digits), 10**digits)}
        return verify(Comparison((Pair("x", sp.Integer(0), X**2 - 2),), given=rounded, rounded=rounded), "seed").verdict

    assert verdict(60) is Verdict.AGREES
    assert verdict(48) is Verdict.DISAGREES


def test_rounded_numbers_beside_free_symbols_are_compared_to_fifty_digits() -> None:
    """The check of a slide that turns disagreed, by the rounding of its Euler parameters."""

    def verdict(digits: int, side: sp.Expr) -> Verdict:
        rounded = {X: sp.Rational(int(sp.sqrt(2).n(80) * 10**digits), 10**digits)}
        pairs = (Pair("x", sp.Integer(0), X**2 - 2), Pair("y", Y + X, side))
        return verify(Comparison(pairs, given=rounded, rounded=rounded), "seed").verdict

    assert verdict(60, X + Y) is Verdict.AGREES
    assert verdict(60, X + 2 * Y) is Verdict.DISAGREES
    assert verdict(48, X + Y) is Verdict.DISAGREES
