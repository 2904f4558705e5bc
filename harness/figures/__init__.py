"""Figures of computed results, in one style.

Each kind of figure has a module.
"""
