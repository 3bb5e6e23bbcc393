"""Files that are written whole or not at all."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path


def write_whole(path: str, content: bytes) -> None:
    """Write the content under the name, or to stdout for ``-``; whatever goes wrong, no half file is left.

    A new file replaces an old one at once and keeps its permissions; devices and pipes are written directly.
    Errors: OSError that names the path.
    """
    if path == "-":
        sys.stdout.buffer.write(content)
        sys.stdout.buffer.flush()
        return
    target = Path(os.path.realpath(path))
    if target.is_dir():
        raise IsADirectoryError(21, os.strerror(21), path)
    if target.exists() and not target.is_file():
        target.write_bytes(content)
        return
    try:
        replace_file(target, content)
    except OSError as error:
        # The name of the file beside it, which is never seen, would only puzzle the reader.
        raise type(error)(error.errno, error.strerror, path) from None


def replace_file(target: Path, content: bytes) -> None:
    """Put the content into a file beside the target, then rename it."""
    handle, beside = tempfile.mkstemp(prefix=f".{target.name[:100]}.", suffix=".part", dir=target.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        os.chmod(beside, permissions(target))
        os.replace(beside, target)
    except BaseException:
        Path(beside).unlink(missing_ok=True)
        raise


def permissions(target: Path) -> int:
    """The mode bits of the file that is replaced, or those a new file would get."""
    if target.exists():
        return target.stat().st_mode & 0o7777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
