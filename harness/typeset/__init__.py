"""Mathematics as a reader of the paper expects it: LaTeX, and MathML made of it.

Every formula goes one way: a tree in MathJSON's shape, boxes that know how wide they are, LaTeX. SymPy expressions are
put into that shape first (`presentation`); what the paper prints comes in it from Maxima, its order kept.
"""
