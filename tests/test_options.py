"""An option is one field of a request: the command line, the arguments in Python and the reference follow from it."""

import inspect
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

import click
import numpy as np
import pytest
from click.testing import CliRunner
from refusing import failing

from holonom.cli.options import takes
from holonom.failures import ErrorKind, HolonomError
from holonom.options import option, options_of, read, spelt_of, takes_options
from holonom.program.request import Request
from holonom.series.request import SeriesRequest
from holonom.simulation.request import SimulationRequest
from holonom.stability.request import EquilibriaRequest
from holonom.sweeps.request import SweepRequest


class Color(StrEnum):
    RED = "red"
    BLUE = "blue"


@dataclass(frozen=True)
class Toy:
    color: Color = option(Color.RED, "Color of the toy.")
    size: int | None = option(None, "Size of the toy.", metavar="N", least=2)
    bought: Fraction | None = option(None, "When it was bought.", spelt=("--when",), metavar="T")
    noisy: bool = option(False, "Make noise.")
    price: float = option(1.5, "Price of the toy.", above=0, most=10)
    owner: str = "none"  # not an option


@click.command()
@takes(*options_of(Toy))
def toy(options):
    click.echo(repr(Toy(**options)))


class Shop:
    @takes_options(*options_of(Toy))
    def toy(self, options, **more):
        """Return a toy.

        Parameters
        ----------
        {options}
        """
        return Toy(**options), more


@pytest.mark.parametrize(
    ("arguments", "made"),
    [
        ([], Toy()),
        (["--color", "blue", "--size", "3"], Toy(Color.BLUE, 3)),
        (["--when", "3/4", "--noisy"], Toy(bought=Fraction(3, 4), noisy=True)),
    ],
)
def test_field_of_request_is_option_of_command(arguments, made):
    assert CliRunner().invoke(toy, arguments).output.strip() == repr(made)


@pytest.mark.parametrize("request_type", [SimulationRequest, SweepRequest, SeriesRequest, EquilibriaRequest, Request])
def test_options_with_other_names_in_python_are_known(request_type):
    for each in options_of(request_type):
        error = HolonomError(ErrorKind.NOT_IN_RANGE, option=spelt_of(each))
        assert str(error).startswith(f"{each.name}: ")


def test_field_of_request_is_argument_in_python():
    assert Shop().toy() == (Toy(), {})
    assert Shop().toy("blue", 3, bought="0.75", m=2) == (Toy(Color.BLUE, 3, Fraction(3, 4)), {"m": 2})
    assert list(inspect.signature(Shop.toy).parameters) == ["self", "color", "size", "bought", "noisy", "price", "more"]
    assert "color : {'red', 'blue'}\n    Color of the toy.\nsize : int or None\n" in Shop.toy.__doc__


@pytest.mark.parametrize(
    ("given", "failure"),
    [
        ({"color": "green"}, ErrorKind.NOT_A_CHOICE),
        ({"color": None}, ErrorKind.NOT_A_CHOICE),
        ({"size": 1}, ErrorKind.NOT_IN_RANGE),
        ({"size": "x"}, ErrorKind.NOT_A_CHOICE),
        ({"size": 2.5}, ErrorKind.NOT_A_CHOICE),
        ({"price": [1]}, ErrorKind.NOT_A_CHOICE),
        ({"price": 0}, ErrorKind.NOT_IN_RANGE),
        ({"price": 11}, ErrorKind.NOT_IN_RANGE),
        ({"bought": "noon"}, ErrorKind.NOT_A_TIME),
        ({"bought": "1e999"}, ErrorKind.NOT_A_TIME),
    ],
)
def test_wrong_value_of_option_is_refused(given, failure):
    with pytest.raises(HolonomError) as refused:
        Shop().toy(**given)
    assert refused.value.kind is failure
    name, value = next(iter(given.items()))
    spelt = "--when" if name == "bought" else f"--{name}"
    assert refused.value.option == spelt
    assert str(refused.value).startswith(f"{spelt[2:]}: ")  # `ARGUMENTS` has the options with other names in Python
    assert refused.value.message().startswith(f"{spelt}: ")
    assert CliRunner().invoke(toy, [spelt, str(value)]).exit_code == 2


def test_not_a_number_is_out_of_every_range():
    with failing(ErrorKind.NOT_IN_RANGE):
        Shop().toy(price=float("nan"))


def test_numbers_of_numpy_are_read_as_pythons():
    made = Shop().toy(size=np.int64(3), price=np.float32(0.5))[0]
    assert (made.size, made.price) == (3, 0.5)
    assert (type(made.size), type(made.price)) == (int, float)


def test_names_of_a_generator_were_lost():
    names = options_of(SimulationRequest, "sensitivities")[0]
    assert read(names, (name for name in ["m", "g"])) == ("m", "g")
