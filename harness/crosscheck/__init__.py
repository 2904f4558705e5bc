"""The independent cross-check: every equation of a record against T, V, Q and f alone.

The record is Maxima's word. What is compared with it is made here, by SymPy, from the system's
description only; the two meet in the comparison and nowhere before.
"""
