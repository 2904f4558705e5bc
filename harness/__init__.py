"""Holonom: runs the Maxima derivation, reads its record, checks it, shows it."""

import os

# Matrices here have some dozens of rows. On a busy machine BLAS takes twenty times as long for them with its threads as
# without, as measured; NumPy reads this when it is first imported.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
