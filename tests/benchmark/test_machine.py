"""Truth: what the interpreter and the packages say of themselves."""

import os
import platform
from datetime import date

import heyoka
import numpy

from holonom.benchmark.machine import this_machine


def test_the_machine_names_its_processor_cores_versions_and_the_day(monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 3, 5}, raising=False)
    machine = this_machine(("heyoka", "numpy", "no such package"))
    assert machine.versions == {
        "Python": platform.python_version(),
        "heyoka": heyoka.__version__,
        "numpy": numpy.__version__,
    }
    assert machine.cores == 3
    assert machine.date == date.today().isoformat()
    for part in (machine.processor, machine.system, machine.date, numpy.__version__):
        assert part in str(machine)


def test_where_the_system_cannot_tell_what_a_process_may_use_all_cores_count(monkeypatch):
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)
    assert this_machine(()).cores == os.cpu_count()
