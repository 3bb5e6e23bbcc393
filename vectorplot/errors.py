"""What goes wrong because of the input, said in one line."""

from __future__ import annotations


class InputError(ValueError):
    """Bad input: names the file, the line (from 1) and the cause.

    ``str(error)`` is one line such as ``pencil.scene:12: CONE: expected a number, got 'x'``. The command prints it
    on stderr and exits with status 1; library users catch it as ValueError.
    """

    def __init__(self, cause: str, *, file: str | None = None, line: int | None = None) -> None:
        self.cause = " ".join(cause.split())
        self.file = file
        self.line = line
        where = "" if file is None else f"{file}: " if line is None else f"{file}:{line}: "
        super().__init__(where + self.cause)


class InputWarning(UserWarning):
    """Input that was mended or read loosely: one line, printed on stderr by the command."""
