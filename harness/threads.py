"""BLAS without threads, for as long as a computation takes."""

from contextlib import AbstractContextManager


def one_blas_thread() -> AbstractContextManager[object]:
    """Keep BLAS to one thread inside the block.

    Matrices here have some dozens of rows. On a busy machine BLAS takes twenty times as long for them with its threads
    as without, as measured.
    """
    from threadpoolctl import threadpool_limits

    return threadpool_limits(1, "blas")
