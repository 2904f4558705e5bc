"""Figures: what a run computed, drawn. One file a figure, one style for all."""
