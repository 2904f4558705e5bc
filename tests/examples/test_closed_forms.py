"""Each example against the closed form that its textbook gives for it."""

from functools import cache
from pathlib import Path

import pytest
import sympy
from sympy import Expr, Symbol, cos, cosh, exp, sin

from holonom.record import Equation, Record, derived_record

EXAMPLES = Path(__file__).parents[2] / "examples"


@cache
def record_of(name: str) -> Record:
    return derived_record(EXAMPLES / f"{name}.mac")


def symbols(names: str) -> tuple[Symbol, ...]:
    return sympy.symbols(names.split(), real=True)


def solved(equations: tuple[Equation, ...], number: str) -> dict[str, Expr]:
    """Right sides by name, of all equations under a number whose left sides are names."""
    return {
        str(relation.left): relation.right
        for equation in equations
        if equation.number == number
        for relation in equation.relations
        if relation.left.is_Symbol
    }


def series_of(record: Record, scene_name: str, coordinate: str) -> Expr:
    """Series (18) of a coordinate with the scene's numbers in it."""
    scene = next(scene for scene in record.scenes if scene.name == scene_name)
    numbers = {Symbol(name, real=True): value for name, value in scene.parameter_values.items()}
    numbers |= {Symbol(f"{name}_0", real=True): value for name, value in scene.initial_state.items()}
    return solved(scene.equations, "18")[coordinate].subs(numbers)


def residual_of(record: Record, scene_name: str) -> list[Expr]:
    """Condition (10) under the scene's control law."""
    scene = next(scene for scene in record.scenes if scene.name == scene_name)
    return [
        relation.right for equation in scene.equations if equation.number == "10" for relation in equation.relations
    ]


def same(left: Expr, right: Expr) -> bool:
    return sympy.simplify(left - right) == 0


def agree_to_third_order(left: Expr, right: Expr) -> bool:
    t = Symbol("t", real=True)
    return all(sympy.simplify((left - right).diff(t, order).subs(t, 0)) == 0 for order in range(4))


class TestPaper:
    def test_multiplier_is_the_papers_with_its_dots_mended(self):
        q1, q2, v1, v2, u, du, ddu = symbols("q1 q2 dot(q1) dot(q2) u dot(u) ddot(u)")
        multiplier = solved(record_of("paper/paper").derivations[0].equations, "8")["lambda1"]
        assert same(multiplier, ((ddu - u) * (q1 + q2) + 2 * (du - u) * (v1 + v2)) / (1 + 2 * u**2))

    def test_exponential_control_gives_free_motion(self):
        assert residual_of(record_of("paper/paper"), "free_motion_scene") == [0]

    def test_free_motion_is_the_solution_of_the_free_equations(self):
        # s = q1 + q2 obeys s'' = -s - 2 s', so s = (a + b t) exp(-t), and q3 = c + d t
        record, t = record_of("paper/paper"), Symbol("t", real=True)
        series = [series_of(record, "free_motion_scene", name) for name in ("q1", "q2", "q3")]
        s0, ds0 = 3, sympy.Rational(1, 6)
        assert agree_to_third_order(series[0] + series[1], (s0 + (ds0 + s0) * t) * exp(-t))
        assert agree_to_third_order(series[2], series[2].subs(t, 0) + series[2].diff(t).subs(t, 0) * t)

    def test_second_coefficient_of_the_initial_motion(self):
        series = series_of(record_of("paper/paper"), "initial_motion_scene", "q1")
        assert sympy.expand(series).coeff(Symbol("t", real=True), 2) == -sympy.Rational(167, 118)


class TestWeightlessCabin:
    def test_floor_carries_m_times_g_plus_acceleration(self):
        m, g, ddu = symbols("m g ddot(u)")
        multiplier = solved(record_of("weightless_cabin").derivations[0].equations, "8")["lambda1"]
        assert same(multiplier, m * (g + ddu))

    def test_free_exactly_in_parabolic_flight(self):
        g, a = symbols("g a")
        assert residual_of(record_of("weightless_cabin"), "parabolic_flight_scene") == [0]
        assert same(residual_of(record_of("weightless_cabin"), "lift_scene")[0], -(g + a))


class TestPendulum:
    def test_string_tension(self):
        # tension S = m (v^2 - u'^2 - u u'' - g y)/u along the string; lambda grad f = -S (x, y)/u on x^2 + y^2 = u^2
        m, g, x, y, vx, vy, u, du, ddu = symbols("m g x y dot(x) dot(y) u dot(u) ddot(u)")
        multiplier = solved(record_of("pendulum").derivations[0].equations, "8")["lambda1"]
        tension = m * (vx**2 + vy**2 - du**2 - u * ddu - g * y) / u
        on_circle = {x: sympy.sqrt(u**2 - y**2)}
        assert same((2 * multiplier * u).subs(on_circle), -tension)

    @pytest.mark.parametrize("scene", ["swing_scene", "lengthening_scene"])
    def test_angular_momentum_changes_by_the_torque_of_gravity(self, scene):
        t = Symbol("t", real=True)
        x, y = (series_of(record_of("pendulum"), scene, name) for name in ("x", "y"))
        torque = -sympy.Rational(981, 100) * x
        rate = (x * y.diff(t, 2) - y * x.diff(t, 2)) - torque
        assert all(abs(sympy.N(rate.diff(t, order).subs(t, 0), 40)) < 1e-35 for order in range(2))


class TestBead:
    def test_bead_and_drive(self):
        m, slider, w, c, t, r, vr, ddu = symbols("m M w c t r dot(r) ddot(u)")
        equations = record_of("bead").derivations[0].equations
        a = c + ddu
        assert same(solved(equations, "11")["ddot(r)"], w**2 * r - a * cos(w * t))
        drive = slider * a + m * (a * sin(w * t) ** 2 - 2 * w * vr * sin(w * t))
        assert same(solved(equations, "8")["lambda1"], drive)

    def test_every_term_of_the_kinetic_energy_is_present(self):
        t = Symbol("t", real=True)
        (split,) = (e for e in record_of("bead").derivations[0].equations if e.number == "3a")
        parts = {str(relation.left): relation.right for relation in split.relations}
        assert parts["A[1, 2]"].diff(t) != 0
        assert parts["B[1]"].diff(t) != 0
        assert parts["T0"] != 0

    def test_slider_at_rest_gives_the_hyperbolic_cosine(self):
        t = Symbol("t", real=True)
        assert agree_to_third_order(series_of(record_of("bead"), "resting_scene", "r"), cosh(2 * t))


class TestWhirlingBob:
    def test_christoffel_symbols_of_polar_coordinates(self):
        # christoffel[k, m, s] stands for [k,m;s] = (dA_ks/dq_m + dA_ms/dq_k - dA_km/dq_s)/2, with A = diag(m, m r^2)
        m, r = symbols("m r")
        (symbols_of_polar,) = (e for e in record_of("whirling_bob").derivations[0].equations if e.number == "6")
        values = {str(relation.left): relation.right for relation in symbols_of_polar.relations}
        assert values == {"christoffel[2, 2, 1]": -m * r, "christoffel[1, 2, 2]": m * r}

    def test_pull_of_the_string(self):
        m, r, rate, ddu = symbols("m r dot(phi) ddot(u)")
        multiplier = solved(record_of("whirling_bob").derivations[0].equations, "8")["lambda1"]
        assert same(multiplier, m * (ddu - r * rate**2))

    def test_angular_momentum_stays_as_the_string_is_drawn_in(self):
        # r^2 dot(phi) = 1 with r = 1 - t/10, so phi = t/(1 - t/10)
        t = Symbol("t", real=True)
        assert agree_to_third_order(series_of(record_of("whirling_bob"), "drawn_in_scene", "phi"), t / (1 - t / 10))
