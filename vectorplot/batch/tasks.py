"""The value Task: a file and how its content is made; and fingerprints, by which a file is known to be up to date."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from vectorplot import __version__


@dataclass(frozen=True)
class Task:
    """A file that is to be made.

    Parameters
    ----------
    path : str
        The file; its folder is made where there is none.
    content : callable
        content() is what is written, as bytes. For workers in other processes it can be pickled: a function of a
        module, or functools.partial of one.
    fingerprint : str
        Of all that the content depends on, as `fingerprint` makes it; where it is that of a file that was written
        before, this is not made again. Without one, the file is always made.

    Examples
    --------
    >>> from functools import partial
    >>> from vectorplot.batch import Task
    >>> Task("out/hello.txt", partial(bytes, 5)).content()
    b'\\x00\\x00\\x00\\x00\\x00'
    """

    path: str
    content: Callable[[], bytes]
    fingerprint: str = ""


def fingerprint(*said: str, files: Iterable[str | os.PathLike[str]] = ()) -> str:
    """What tells a picture from another one: a hash of the version of the package, of texts, and of what files hold.

    Parameters
    ----------
    said : str
        All that the picture depends on, beside the files.
    files : iterable of str or path
        The files it is made of: names do not matter, contents and their order do.

    Returns
    -------
    str
        32 hexadecimal digits.

    Raises
    ------
    OSError
        For a file that cannot be read.

    Notes
    -----
    It is the first 128 bits of a SHA-256 sum: two pictures with the same one of these are the same but with a
    probability of about 1e-38.

    Examples
    --------
    >>> from vectorplot.batch import fingerprint
    >>> fingerprint("frame", "12") == fingerprint("frame", "12")
    True
    >>> fingerprint("frame", "12") == fingerprint("frame1", "2")
    False
    """
    whole = hashlib.sha256()
    for part in (__version__, *said):
        whole.update(hashlib.sha256(part.encode("utf-8", "surrogatepass")).digest())
    for path in files:
        with Path(path).open("rb") as file:
            whole.update(hashlib.file_digest(file, "sha256").digest())
    return whole.hexdigest()[:32]
