"""Linearised motions, equilibria and their stability."""
