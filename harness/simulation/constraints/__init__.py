"""Numerical constraints: factorization, projection, stabilization and monitoring."""
