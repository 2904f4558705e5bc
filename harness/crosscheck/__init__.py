"""The independent cross-check of a record's equations with T, V, Q and f alone.

Maxima wrote the record. SymPy makes the other side of each comparison from the system's description only. The two
sides meet in the comparison.
"""
