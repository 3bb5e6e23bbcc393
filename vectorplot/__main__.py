"""The command: ``vectorplot``, and ``python -m vectorplot``."""

from __future__ import annotations

import os
import signal


def _end(number: int, frame: object) -> None:
    """Ends the process in one line, before the command has loaded what stops it in order."""
    os.write(2, b"vectorplot: interrupted\n")
    os._exit(128 + number)


def main() -> None:
    """What the shell starts. From here on Ctrl-C ends it in one line, while it loads its modules, too."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _end)
    from vectorplot.cli.main import main as command

    command()


if __name__ == "__main__":
    main()
