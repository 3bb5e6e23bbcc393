"""The files that a scene file may name: meshes, and other scenes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from vectorplot.io.meshes.mesh_file import check_file
from vectorplot.io.scenes.scene_words import Words

DEEPEST = 16
"""So many scene files may include one another in a row."""

MOST_FILES = 1000
"""So many files a scene may be made of."""


@dataclass(frozen=True)
class NamedFiles:
    """Where the names of files in a scene file lead to.

    root: the folder of the file that the user named, out of which nothing is read; chain: the files that include one
    another, the one that is read last; opened: all that were read, which grows.
    """

    root: Path
    chain: tuple[Path, ...]
    opened: list[Path] = field(default_factory=list)

    @classmethod
    def of(cls, path: Path) -> NamedFiles:
        """Those of a file that the user named."""
        found = path.resolve()
        return cls(found.parent, (found,))

    def named(self, words: Words, at: int, owner: str, suffixes: Sequence[str] = ()) -> Path:
        """The file that a string names, relative to the file it stands in.

        Errors: InputError, with the line of the name, for what is no string, leads out of the folder, is not there, is
        not of the suffixes, and for too many files.
        """
        if not words.words[at].startswith('"'):
            words.fail(at, f"{owner}expected the name of a file in quotes, got {words.shown(at)}")
        name = words.string(at)
        if suffixes and Path(name).suffix.lower() not in suffixes:
            words.fail(at, f"{owner}{name!r}: expected a file that ends in {', '.join(suffixes)}")
        try:
            path = (self.chain[-1].parent / name).resolve()
        except (OSError, ValueError, RuntimeError):
            words.fail(at, f"{owner}{name!r} is no name of a file")
        if not path.is_relative_to(self.root):
            words.fail(at, f"{owner}{name!r} lies outside the folder of the scene")
        if not path.is_file():
            words.fail(at, f"{owner}{name!r}: no such file")
        self.opened.append(path)
        if len(self.opened) > MOST_FILES:
            words.fail(at, f"{owner}more than {MOST_FILES} files")
        return path

    def within(self, words: Words, at: int, path: Path) -> NamedFiles:
        """Those of a scene that is included. Errors: InputError for one that includes itself, and too many in a row."""
        if path in self.chain:
            words.fail(at, f"include: {path.name!r} includes itself")
        if len(self.chain) >= DEEPEST:
            words.fail(at, f"include: more than {DEEPEST} scenes in one another")
        check_file(path)
        return replace(self, chain=(*self.chain, path))
