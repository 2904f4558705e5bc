"""Parameter sweeps: one motion for many parameter values, as a Parquet dataset.

Batch elements are independent. The rows are computed chunk by chunk.
"""
