"""A million motions of the crane by JAX and diffrax, on whatever device JAX finds, beside the rows of a sweep.

    holonom program examples/crane.mac --to python --module jax --parameters m,c -o crane.py
    holonom sweep examples/crane.mac --grid m=50:500:10 --grid c=0:40:10 -o rows
    python -c "import pandas; pandas.read_parquet('rows').to_csv('rows.csv', index=False)"
    python tests/benchmarks/jax_crane.py crane.py rows.csv [COUNT] > tests/benchmarks/jax_crane.txt

It needs jax, diffrax and NumPy, and neither Holonom nor Maxima. COUNT motions, 1000 squared without it, differ in the
mass of the load and in the brake, as in `sweep.py`. The states at the end are compared with the 100 rows, which lie on
the same grid where COUNT is (9 k + 1) squared.
"""

import csv
import importlib.util
import sys
import time
from math import isqrt

import jax

jax.config.update("jax_enable_x64", True)

import diffrax  # noqa: E402
import jax.numpy as jnp  # noqa: E402
import numpy as np  # noqa: E402

TOLERANCE, END = 1e-12, 10.0
MASS, BRAKE, ROWS = (50.0, 500.0), (0.0, 40.0), 10
REPEATS = 3


def load(file):
    """Import the exported module."""
    spec = importlib.util.spec_from_file_location("crane", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def ends(crane):
    """Return the function of the parameters, shape (2, k), whose values are states at the end, shape (k, 2n)."""

    def rate(t, y, p):
        return jnp.concatenate([y[3:], crane.motion(t, y, crane.law(t, p), p)[:3]])

    def follow(p):
        steps = diffrax.PIDController(rtol=TOLERANCE, atol=TOLERANCE)
        solution = diffrax.diffeqsolve(
            diffrax.ODETerm(rate),
            diffrax.Dopri8(),
            0.0,
            END,
            None,
            jnp.array(crane.Y0, dtype=float),
            p,
            stepsize_controller=steps,
            saveat=diffrax.SaveAt(t1=True),
            max_steps=4096,
        )
        return solution.ys[0], solution.stats["num_steps"]

    return jax.jit(jax.vmap(follow, in_axes=1))


def main(module, rows, count=1_000_000):
    """Print the measures."""
    side = isqrt(int(count))
    across, up = (np.linspace(*span, side) for span in (MASS, BRAKE))
    parameters = jnp.array([np.repeat(across, side), np.tile(up, side)])
    crane = load(module)
    run = ends(crane)
    times = []
    for _ in range(1 + REPEATS):
        begun = time.perf_counter()
        states, steps = jax.block_until_ready(run(parameters))
        times.append(time.perf_counter() - begun)
    device, least = jax.devices()[0], min(times[1:])
    print(
        f"{device.platform}, {device.device_kind}; JAX {jax.__version__}, diffrax {diffrax.__version__}, {states.dtype}"
    )
    each = f"{least:.2f} s, {least / side**2 * 1e6:.3f} us a motion"
    print(f"{side**2} motions to t = {END:g}, tolerance {TOLERANCE:g}: {each}")
    print(f"first run, compilation too: {times[0]:.1f} s; steps of a motion: {int(steps.min())} to {int(steps.max())}")
    if (side - 1) % (ROWS - 1) == 0:
        with open(rows, newline="") as file:
            known = [[float(row[name]) for name in crane.STATE] for row in csv.DictReader(file)]
        places = np.arange(0, side, (side - 1) // (ROWS - 1))
        found = np.asarray(states).reshape(side, side, -1)[np.ix_(places, places)].reshape(ROWS**2, -1)
        print(f"largest difference from {ROWS**2} rows of the sweep: {np.abs(found - np.array(known)).max():.1e}")


if __name__ == "__main__":
    main(*sys.argv[1:])
