"""Expressions: trees, their functions, and notations of them both ways."""
