"""What is particular to the C form: the compiler, names, and shapes."""

import ctypes
import shutil
from fractions import Fraction

import numpy as np
import pytest
from programs import PENDULUM, program
from refusing import failing

from holonom.expression.infix import atom
from holonom.failures import ErrorKind
from holonom.program.c_function import compile_c, has_compiler, load_c
from holonom.program.c_source import MANY, ONE, c_source


def test_without_a_compiler_one_sentence_says_so(monkeypatch, tmp_path):
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert not has_compiler()
    with failing(ErrorKind.COMPILER_MISSING):
        compile_c(PENDULUM)


def test_the_compiler_that_cc_names_is_the_one_used(monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler -O3")
    with failing(ErrorKind.COMPILER_MISSING):
        compile_c(PENDULUM)


def test_what_the_compiler_says_is_passed_on(c_compiler):
    with failing(ErrorKind.COMPILER_REFUSED, "unknown_type"):
        load_c("unknown_type x;")


def test_a_compiler_that_knows_no_native_processor_was_no_compiler(monkeypatch, tmp_path):
    """GCC for RISC-V and POWER: what it says there."""
    refusing = tmp_path / "riscv64-gcc"
    refusing.write_text(
        '#!/bin/sh\ncase " $* " in *" -march=native "*)\n'
        "  echo \"cc1: error: '-march=native': ISA string must begin with rv32 or rv64\" >&2; exit 1 ;;\nesac\n"
        f'exec {shutil.which("cc")} "$@"\n'
    )
    refusing.chmod(0o755)
    points = np.random.default_rng(2).normal(size=(6, 5))
    native = compile_c(PENDULUM)(points)
    monkeypatch.setenv("CC", str(refusing))
    assert compile_c(PENDULUM)(points) == pytest.approx(native, rel=1e-12)


def test_square_roots_and_small_powers_do_not_call_pow():
    def written(target, exponent):
        return target.arithmetic.power(atom("x"), Fraction(exponent)).text

    assert [written(ONE, exponent) for exponent in ("1/2", 2, 3, 1)] == ["sqrt(x)", "square(x)", "cube(x)", "x"]
    assert [written(ONE, exponent) for exponent in (4, 9, -2)] == [
        "square(square(x))",
        "cube(cube(x))",
        "1.0/square(x)",
    ]
    assert written(MANY, "1/2") == "lanes_sqrt(x)"
    assert all(written(ONE, exponent).startswith("pow(x, ") for exponent in ("1/3", 5, 17, 18))


def test_names_from_the_program_stay_inside_the_comment():
    name = '*/ int stolen = 1; /* \\\n"'
    written = program([name], [("w", ["Add", name, 1])], {name: "w"})
    assert compile_c(written)([1.0]) == [2.0]
    with pytest.raises(ValueError, match="stolen"):
        ctypes.c_int.in_dll(load_c(c_source(written)), "stolen")


def test_without_gnu_vectors_the_source_is_plain_c99():
    points = np.random.default_rng(1).normal(size=(6, 11))
    plain = load_c(c_source(PENDULUM).replace("#ifdef __GNUC__", "#if 0"))
    result = np.empty((3, 11))
    plain.motion_batch(ctypes.c_size_t(11), ctypes.c_void_p(points.ctypes.data), ctypes.c_void_p(result.ctypes.data))
    assert result == pytest.approx(compile_c(PENDULUM)(points), rel=1e-12)


@pytest.mark.parametrize("shape", [(), (5,), (6, 2, 2)])
def test_other_shapes_are_refused(shape):
    with pytest.raises(ValueError, match="needed"):
        compile_c(PENDULUM)(np.zeros(shape))
