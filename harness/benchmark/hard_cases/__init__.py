"""The register of hard cases: motions on which a plain method loses its digits, each measured against a truth."""
