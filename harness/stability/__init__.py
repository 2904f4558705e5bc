"""Motions near a motion: linearisation."""
