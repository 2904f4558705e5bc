"""What a sweep varies: every row is a function of its number and the seed."""

import numpy as np
import pytest
from refusing import failing

from holonom.failures import ErrorKind
from holonom.sweeps.axes import axes_of, read_axes, read_grids


def test_the_last_parameter_varies_fastest():
    axes = read_axes(["m=1:3:3"], ["c=5,7/2"], [], None, None)
    assert (axes.names, axes.rows) == (("m", "c"), 6)
    assert axes.numbers(0, 6).tolist() == [[1, 1, 2, 2, 3, 3], [5, 3.5, 5, 3.5, 5, 3.5]]
    assert axes.numbers(3, 5).tolist() == [[2, 3], [3.5, 5]]


def test_a_row_of_a_sample_does_not_hang_on_where_the_chunks_are_cut():
    axes = read_axes(["c=0:1:2"], [], ["m=normal(100,5)", "k=loguniform(1e-3,10)"], 5000, 7)
    whole = axes.numbers(0, axes.rows)
    assert (axes.numbers(3000, 5000) == whole[:, 3000:5000]).all()
    assert (axes.numbers(4711, 4712) == whole[:, 4711:4712]).all()
    assert (axes.numbers(0, 10) != read_axes(["c=0:1:2"], [], ["m=normal(100,5)"], 5000, 8).numbers(0, 10)[0]).any()


def test_samples_have_the_moments_of_their_distributions():
    drawn = ["a=normal(100,5)", "b=uniform(-1,3)", "c=loguniform(0.01,100)"]
    a, b, c = read_axes([], [], drawn, 200_000, 3).numbers(0, 200_000)
    assert (a.mean(), a.std()) == (pytest.approx(100, abs=0.05), pytest.approx(5, abs=0.03))
    assert (b.mean(), b.std()) == (pytest.approx(1, abs=0.02), pytest.approx(4 / 12**0.5, abs=0.01))
    assert np.log10(c).mean() == pytest.approx(0, abs=0.02)
    assert np.corrcoef([a, b, c])[np.triu_indices(3, 1)] == pytest.approx([0, 0, 0], abs=0.01)


@pytest.mark.parametrize(
    ("grids", "lists", "samples", "size"),
    [
        (["m=1:2"], [], [], None),
        (["m=1:2:0"], [], [], None),
        (["m=1:x:3"], [], [], None),
        (["=1:2:3"], [], [], None),
        (["m=1:1/0:3"], [], [], None),
        (["m=0:1e999:3"], [], [], None),
        ([], ["m="], [], None),
        ([], [], ["m=cauchy(0,1)"], 10),
        ([], [], ["m=normal(0,0)"], 10),
        ([], [], ["m=uniform(2,1)"], 10),
        ([], [], ["m=loguniform(0,1)"], 10),
    ],
)
def test_a_malformed_axis_raises_with_its_option(grids, lists, samples, size):
    with failing(ErrorKind.MALFORMED_AXIS) as raised:
        read_axes(grids, lists, samples, size, None)
    assert raised.value.option == ("--grid" if grids else "--list" if lists else "--sample")


def test_a_malformed_range_names_the_option_that_it_is_of():
    with failing(ErrorKind.MALFORMED_AXIS) as raised:
        list(read_grids("--over", ["u=1"]))
    assert raised.value.option == "--over"


@pytest.mark.parametrize(
    ("grids", "lists", "samples", "size"),
    [
        (["m=1:2:3"], ["m=1,2"], [], None),
        ([], [], ["m=normal(0,1)"], None),
        (["m=1:2:3"], [], [], 10),
        (["m=0:1:999999999", "c=0:1:999999999"], [], [], None),
    ],
)
def test_axes_that_do_not_go_together_raise(grids, lists, samples, size):
    with failing(ErrorKind.NOT_AN_AXIS):
        read_axes(grids, lists, samples, size, None)


def test_values_of_an_array_were_asked_for_their_truth():
    assert axes_of(None, {"m": np.array([1.0, 2.5])}, None, None, None) == read_axes([], ["m=1.0,2.5"], [], None, None)
    with failing(ErrorKind.NOT_AN_AXIS):
        axes_of(None, {"m": np.array([])}, None, None, None)


@pytest.mark.parametrize(
    ("grids", "lists", "samples"),
    [
        ({"m": (1, 2)}, None, None),
        ([1], None, None),
        ({"m": "1:2"}, None, None),
        ({1: (1, 2, 3)}, None, None),
        (None, {"m": 2}, None),
        (None, {"m": "1,2"}, None),
        (None, {"m": ["1,2"]}, None),
        (None, None, {"m": (0, 1)}),
    ],
)
def test_an_argument_of_another_form_raises(grids, lists, samples):
    with failing(ErrorKind.MALFORMED_AXIS):
        axes_of(grids, lists, samples, None, None)


@pytest.mark.parametrize(("size", "seed"), [(0, None), (-1, None), (1.5, None), (3, -1), (3, 0.5), (3, "x")])
def test_a_size_or_seed_that_is_no_such_number_raises(size, seed):
    with failing(ErrorKind.NOT_AN_AXIS):
        axes_of(None, None, {"m": "normal(0,1)"}, size, seed)


def test_arguments_and_options_give_the_same_axes():
    options = read_axes(["m=1:2:3"], ["c=1,2"], ["k=normal(0,1)"], 5, 7)
    assert axes_of({"m": (1, 2, 3)}, {"c": [1, 2]}, {"k": "normal(0,1)"}, 5, 7) == options


def test_no_axis_raises():
    with failing(ErrorKind.NOTHING_VARIES):
        read_axes([], [], [], None, None)
