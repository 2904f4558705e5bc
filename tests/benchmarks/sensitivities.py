"""`make bench`: what derivatives of a motion take, in terms of the motion alone, with its bar.

    python tests/benchmarks/sensitivities.py build/benchmarks

Processor time of a simulation whose programs are compiled, the least of some taken in turns with the motion's.
"""

import sys
import time
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from timing import write_report

from holonom import load, system
from holonom.scene import Scene

EXAMPLES = Path(__file__).parents[2] / "examples"
DOUBLE_PENDULUM = """
pendulums : holonomic_system(coordinates = [a, b], parameters = [m, M, l, L, g],
  kinetic_energy = M*L^2*dot(a)^2/2 + m*(L^2*dot(a)^2 + l^2*dot(b)^2 + 2*L*l*dot(a)*dot(b)*cos(a - b))/2,
  potential_energy = -(M + m)*g*L*cos(a) - m*g*l*cos(b))$
swinging : holonomic_scene(pendulums, parameter_values = [m = 1, M = 1, l = 1, L = 1, g = 981/100],
  initial_state = [a = 2, dot(a) = 0, b = 1, dot(b) = 0], time_span = [0, 10])$
"""
COUNTS, TURNS = (1, 2, 4), 7


@dataclass(frozen=True)
class Case:
    """A motion, and parameters and initial values by which it is differentiated."""

    name: str
    scene: Scene
    until: float
    value: Fraction  # of the first parameter, which is open without derivatives, too
    names: tuple[str, ...]

    def seconds(self, count: int) -> float:
        """Processor time of the motion with the first derivatives."""
        begun = time.process_time()
        value = {self.names[0]: self.value}
        self.scene.simulate(until=self.until, samples=101, sensitivities=self.names[:count], **value)
        return time.process_time() - begun


def cases() -> list[Case]:
    """Motions of two to seven coordinates."""
    return [
        Case("pendulum", load(EXAMPLES / "pendulum.mac"), 300, Fraction(981, 100), ("g", "m", "x", "dot(x)")),
        Case("double pendulum", system(DOUBLE_PENDULUM), 100, Fraction(1), ("m", "M", "l", "L")),
        Case("heavy top", load(EXAMPLES / "heavy_top.mac"), 60, Fraction(1, 2), ("m", "I1", "I3", "g")),
        Case("satellite", load(EXAMPLES / "satellite.mac"), 300, Fraction(1), ("m", "M", "x", "dot(x)")),
    ]


def bar(count: int) -> float:
    """Motions that derivatives in some directions may cost."""
    return 1 + 1.5 * count


def row(case: Case) -> str:
    """The ratios of one motion."""
    counts = (0, *COUNTS)
    for count in counts:
        case.seconds(count)
    turns = [[case.seconds(count) for count in counts] for _ in range(TURNS)]
    alone, *others = (min(each) for each in zip(*turns, strict=True))
    ratios = [(other / alone, bar(count)) for other, count in zip(others, COUNTS, strict=True)]
    cells = (f"{ratio:8.2f}{' ' if ratio <= most else '!'}" for ratio, most in ratios)
    return f"{case.name:18s}{alone:10.3f} s  {' '.join(cells)}"


def main(directory: Path) -> None:
    """Write the table."""
    heads = " ".join(f"{f'p = {count}':>9s}" for count in COUNTS)
    bars = " ".join(f"{bar(count):8.2f} " for count in COUNTS)
    lines = [
        "A motion with its derivatives in p directions, in terms of the motion alone; ! misses its bar.",
        f"{'':18s}{'the motion':>12s}  {heads}",
        *map(row, cases()),
        f"{'at most':30s}  {bars}",
    ]
    write_report(directory / "sensitivities.txt", "\n".join(line.rstrip() for line in lines) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
