"""Numerical motion of a scene: engines, constraint stabilization and results."""
