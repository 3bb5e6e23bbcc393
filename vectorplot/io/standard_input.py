"""Standard input -> a scene: what another program writes in the scene language."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path

from vectorplot.errors import InputError
from vectorplot.io.folders import data_file
from vectorplot.io.foreign import foreign_kind
from vectorplot.io.read_file import read
from vectorplot.scene.scene import Scene

STANDARD_INPUT = "-"
"""What stands for standard input where a file is expected."""

_NAME = "standard input"
"""What messages call it."""


def read_named(name: str, *, exaggeration: float | None = None) -> Scene:
    """The scene in the file of a name, as io.read_file.read has it, which is looked for in the current folder and then
    in data/, as it is and with the suffix .scene; of the name ``-`` the one in the scene language on
    standard input, in which names of files are relative to the folder that one is in.

    Errors: InputError as of read; for a text that is empty, larger than 64 MiB, not UTF-8 or something else.
    """
    if name != STANDARD_INPUT:
        with suppress(InputError):
            name = os.fspath(data_file(name))
        return read(name, exaggeration=exaggeration)
    from vectorplot.io.scenes.scene_language import MAX_FILE_BYTES, parse_scene

    if exaggeration is not None:
        raise InputError("heights are exaggerated of terrains only (asc, xyz)", file=_NAME)
    if sys.stdin is None:
        raise InputError("it is closed", file=_NAME)
    data = sys.stdin.buffer.read(MAX_FILE_BYTES + 1)
    if not data:
        raise InputError("nothing came in", file=_NAME)
    if len(data) > MAX_FILE_BYTES:
        raise InputError(f"larger than {MAX_FILE_BYTES >> 20} MiB: this is no scene", file=_NAME)
    kind = foreign_kind(Path(STANDARD_INPUT), data)
    if kind:
        raise InputError(f"{kind}; standard input is read as a scene", file=_NAME)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError("not UTF-8: this is no scene", file=_NAME, line=line) from None
    return parse_scene(text, _NAME, beside=os.path.join(os.curdir, STANDARD_INPUT))
