"""Test set of hard cases: motions on which a naive method loses digits.

Each method is compared with a reference solution.
"""
