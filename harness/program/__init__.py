"""Program to numbers: the motion program as NumPy, C, Python and heyoka functions."""
