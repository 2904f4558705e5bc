"""Typeset mathematics as LaTeX, and as MathML made of it.

Every formula passes through the same steps: a tree in MathJSON's shape, boxes with widths, LaTeX. SymPy expressions
are first brought into that shape (`presentation`). Equations of the paper come in it from Maxima, in their order.
"""
