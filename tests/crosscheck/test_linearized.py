"""Sizes that the check of a linearisation compares rounding errors with."""

import numpy as np
import pytest

from holonom.crosscheck.linearized import ROUNDED, _product_sizes


@pytest.mark.parametrize("seed", range(5))
def test_sizes_of_a_product_are_those_of_its_terms_and_zeros_have_one(seed):
    random = np.random.default_rng(seed)
    a, b = random.normal(size=(3, 4)) * random.integers(0, 2, (3, 4)), random.normal(size=(4, 2))
    b[:, 0] = 0
    terms = np.array([[sum(abs(x * y) for x, y in zip(row, column, strict=True)) for column in b.T] for row in a])
    beyond = _product_sizes(a, b) - terms
    assert (beyond <= ROUNDED * a.size * abs(a).max() * abs(b).max()).all()
    assert (beyond[abs(a).any(axis=1)] > 0).all()
