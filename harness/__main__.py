"""``python -m holonom``, and the command ``holonom``."""

import signal


def main() -> None:
    """Run the command line. An earlier interruption ends the process silently."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from .cli import main as command

    command()


if __name__ == "__main__":
    main()
