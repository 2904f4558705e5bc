"""``python -m holonom``: the same commands as ``holonom``."""

from .cli import main

if __name__ == "__main__":
    main()
