"""The textbook companion: the paper as a living book, made of static pages out of runs of this repository.

A chapter says which runs it needs and what it makes of their results; a template turns that into a page. Numbers,
equations and verdicts on the pages come from the runs, and the Maxima lines from the source files, at every build.
"""
