"""Engines that integrate a motion, with one protocol."""
