"""The benchmarks: what accuracy costs in time, and what is hard to compute."""
