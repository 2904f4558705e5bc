"""Results show their table at the Python prompt."""

import importlib
import pkgutil

import holonom
from holonom.shown import Shown


def test_no_result_prints_its_fields():
    for module in pkgutil.walk_packages(holonom.__path__, "holonom."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
    assert len(Shown.__subclasses__()) > 5
    assert [each.__name__ for each in Shown.__subclasses__() if each.__repr__ is not Shown.__repr__] == []
