"""The constraints in numbers: factored, projected onto, built into the equations, watched."""
