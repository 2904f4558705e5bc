"""Work-precision study: one motion by many methods, compared with one reference."""
