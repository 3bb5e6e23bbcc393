"""The record of what is finished: a file in every folder, with a line for every picture that was written into it."""

from __future__ import annotations

import json
import os
from pathlib import Path

RECORD = ".vectorplot-finished"
"""Its name. A line is a JSON list: name of the file, fingerprint, bytes."""

_FOLDERS = 8
"""Of so many folders the records are held in memory."""


class Records:
    """What was written before, by folders; of few folders at a time."""

    def __init__(self) -> None:
        self.known: dict[Path, dict[str, tuple[str, int]]] = {}

    def has(self, path: str, fingerprint: str) -> bool:
        """Whether a file with this fingerprint is there, whole."""
        where = Path(path)
        if not fingerprint or self._of(where.parent).get(where.name, ("", 0))[0] != fingerprint:
            return False
        try:
            # A machine that lost its power may have kept the name of a file and not what is in it.
            return where.stat().st_size == self._of(where.parent)[where.name][1]
        except OSError:
            return False

    def add(self, path: str, fingerprint: str, size: int) -> None:
        """Note that a file was written. Errors: OSError that names the record."""
        if not fingerprint:
            return
        where = Path(path)
        self._of(where.parent)[where.name] = (fingerprint, size)
        line = json.dumps([where.name, fingerprint, size]) + "\n"
        record = os.open(where.parent / RECORD, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o666)
        try:
            os.write(record, line.encode("ascii"))
        finally:
            os.close(record)

    def _of(self, folder: Path) -> dict[str, tuple[str, int]]:
        found = self.known.pop(folder, None)
        if found is None:
            found = _read(folder / RECORD)
            while len(self.known) >= _FOLDERS:
                del self.known[next(iter(self.known))]
        self.known[folder] = found
        return found


def _read(record: Path) -> dict[str, tuple[str, int]]:
    """By names: fingerprints and sizes. Degenerate: lines that are none, as one that was broken off, say nothing."""
    found: dict[str, tuple[str, int]] = {}
    try:
        text = record.read_text(encoding="ascii", errors="replace")
    except OSError:
        return found
    for line in text.splitlines():
        try:
            name, fingerprint, size = json.loads(line)
            found[str(name)] = (str(fingerprint), int(size))
        except (ValueError, TypeError, RecursionError):
            continue
    if text and not text.endswith("\n"):
        with record.open("a", encoding="ascii") as file:
            file.write("\n")
    return found
