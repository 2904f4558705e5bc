"""Benchmarks: time against accuracy, and problems that are hard to compute."""
