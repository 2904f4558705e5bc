"""The machine of a measurement, shown with every table and figure of times."""

import platform
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from ..processes import usable_cores
from ..structs import entry

PROCESSORS = Path("/proc/cpuinfo")
PACKAGES = ("heyoka", "numpy", "scipy", "scikit-sundae", "mpmath")


@dataclass(frozen=True)
class Machine:
    """A machine on a day."""

    processor: str = entry("Name of the processor.")
    cores: int = entry("Number of processor cores that the process may use.", minimum=1)
    system: str = entry("Operating system.")
    versions: Mapping[str, str] = entry("Version of each program, by its name.")
    date: str = entry("Date of the measurement, ISO 8601.", format="date")

    def __str__(self) -> str:
        versions = ", ".join(f"{name} {number}" for name, number in self.versions.items())
        cores = f"{self.cores} core{'' if self.cores == 1 else 's'}"
        return f"{self.processor}, {cores}, {self.system}; {versions}; {self.date}"


def this_machine(packages: tuple[str, ...] = PACKAGES) -> Machine:
    """Return this machine, today's date and the versions of installed packages.

    Parameters
    ----------
    packages : tuple of str
        Names of packages whose versions are recorded.

    Returns
    -------
    Machine
    """
    versions = {"Python": platform.python_version()}
    for package in packages:
        try:
            versions[package] = version(package)
        except PackageNotFoundError:
            continue
    return Machine(
        processor=_processor(),
        cores=usable_cores(),
        system=f"{platform.system()} {platform.machine()}",
        versions=versions,
        date=date.today().isoformat(),
    )


def _processor() -> str:
    try:
        lines = PROCESSORS.read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    named = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(named, platform.processor() or "unknown processor")
