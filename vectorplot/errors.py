"""What goes wrong because of the input, said in one line."""

from __future__ import annotations

_HEAD, _TAIL = 300, 700
"""A longer message keeps so many of its first and of its last letters: what it is about, and the cause."""

_LONGEST_WORD, _BEGIN, _END = 200, 80, 20
"""A longer word of a message, such as a file name, keeps so many of its first and of its last letters."""


class InputError(ValueError):
    """Bad input: names the file, the line (from 1) and the cause.

    Parameters
    ----------
    cause : str
        What is wrong.
    file : str, optional
        The file it is wrong in.
    line : int, optional
        The line, from 1.

    Notes
    -----
    ``str(error)`` is one line such as ``pencil.scene:12: CONE: expected a number, got 'x'``, which a terminal shows and
    does not obey, whatever names the input holds. The command prints it on stderr and exits with status 1; library
    users catch it as ValueError.

    Examples
    --------
    >>> import vectorplot as vp
    >>> try:
    ...     vp.Material("glue")
    ... except ValueError as error:
    ...     print(str(error)[:16], error.file)
    material 'glue': None
    >>> print(vp.InputError("expected a number", file="pencil.scene", line=12))
    pencil.scene:12: expected a number
    """

    def __init__(self, cause: str, *, file: str | None = None, line: int | None = None) -> None:
        self.cause = _shortened(printable(cause))
        self.file = None if file is None else printable(file)
        self.line = line
        where = "" if file is None else f"{self.file}: " if line is None else f"{self.file}:{line}: "
        super().__init__(where + self.cause)


class InputWarning(UserWarning):
    """Input that was repaired or read loosely: one line, printed on stderr by the command.

    Parameters
    ----------
    message : str
        What was done about it.

    Examples
    --------
    >>> import vectorplot as vp
    >>> print(vp.InputWarning("three faces dropped"))
    three faces dropped
    """

    def __init__(self, message: str) -> None:
        super().__init__(_shortened(printable(message)))


def not_installed(what: str, package: str, extra: str) -> InputError:
    """The error for what needs a package that only an extra of this one brings."""
    return InputError(f"{what} needs {package}: pip install '.[{extra}]' in the checkout of vectorplot")


def printable(text: str) -> str:
    """The text in one line of letters that show: blanks of all kinds become one, and ? stands for everything that could
    steer a terminal (control characters of both sets, marks of direction, halves of surrogate pairs)."""
    line = " ".join(text.split())
    return line if line.isprintable() else "".join(letter if letter.isprintable() else "?" for letter in line)


def _shortened(line: str) -> str:
    words = line.split(" ")
    line = " ".join(word if len(word) <= _LONGEST_WORD else f"{word[:_BEGIN]}...{word[-_END:]}" for word in words)
    return line if len(line) <= _HEAD + _TAIL else f"{line[:_HEAD]} ... {line[-_TAIL:]}"
