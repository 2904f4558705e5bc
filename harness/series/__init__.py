"""The initial motion as power series, with continuation and radius of convergence."""
