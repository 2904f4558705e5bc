"""Holonom's harness: runs the Maxima derivation, reads its record, checks it, shows it."""
