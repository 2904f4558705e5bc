"""``python -m harness``: the same commands as ``holonom``."""

from harness.cli import main

if __name__ == "__main__":
    main()
