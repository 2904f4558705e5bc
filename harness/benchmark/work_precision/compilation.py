"""Compilations that are what they would be the first time."""

from collections.abc import Iterator
from contextlib import contextmanager

from ...program.heyoka_function import import_heyoka


@contextmanager
def without_caches() -> Iterator[None]:
    """Let heyoka compile anew inside the block what its caches, in memory and on disk, hold already.

    Raises
    ------
    HolonomError
        heyoka is not installed.
    """
    state = import_heyoka().llvm_state
    limit, enabled = state.get_memcache_limit(), state.get_diskcache_enabled()
    state.set_memcache_limit(0)
    state.set_diskcache_enabled(False)
    try:
        yield
    finally:
        state.set_memcache_limit(limit)
        state.set_diskcache_enabled(enabled)
