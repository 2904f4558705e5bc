"""The chapters about somebody's own scene file, one a module: each has a function `chapter(prefix, file, study)`."""
