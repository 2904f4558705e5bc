"""Sweeps: one motion for many values of its parameters, lane by lane, chunk by chunk, to a Parquet dataset."""
