"""`make pictures`: the README's figure of the radius of convergence.

python tests/benchmarks/radius.py examples/paper/radius.svg
"""

import sys
from pathlib import Path

from holonom.companion.convergence import draw_radius, find_radii
from holonom.files import write_whole

if __name__ == "__main__":
    write_whole(Path(sys.argv[1]), draw_radius(find_radii()))
