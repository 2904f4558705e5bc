"""The initial motion as power series: coefficients, continuation, radius of convergence."""
