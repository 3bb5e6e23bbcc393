"""The files that a scene file may name: meshes, and other scenes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from vectorplot.errors import InputError
from vectorplot.io.mesh_file import check_file
from vectorplot.io.scene_words import Words

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


# Where data files, animation files and movies lie, and what they are called where only a part of the name is given.
#
# Source: Glaeser, appendix A.1 to A.3.

DATA, ANIMATIONS, VIDEOS = Path("data"), Path("anim"), Path("video")
"""The folders, beside each other in the current one."""

SCENE, ANIMATION = ".scene", ".anim"
"""Suffixes that may be left out."""

VIDEO = VIDEOS / "tmp"
"""The name of a movie that has none."""


def data_file(name: str) -> Path:
    """The data file of a name: in the current folder, then in DATA; as it is, then with the suffix SCENE.

    Errors: InputError where there is none.
    """
    return _found(name, (Path(), DATA), SCENE, "data file")


def animation_file(name: str) -> Path:
    """The animation file of a name: in the current folder, then in ANIMATIONS, then in DATA; as it is, then
    with the suffix ANIMATION.

    Errors: InputError where there is none.
    """
    return _found(name, (Path(), ANIMATIONS, DATA), ANIMATION, "animation file")


def movie_to_write(name: str | None) -> Path:
    """The movie of a name without suffix: a name alone lies in VIDEOS; None is VIDEO."""
    path = VIDEO if name is None else Path(name)
    return VIDEOS / path if path.parent == Path() and not path.is_absolute() else path


def movie_to_read(name: str) -> Path:
    """The movie of a name, with or without a suffix: in the current folder, then in VIDEOS, then in DATA.

    Errors: InputError where there is none.
    """
    path = Path(name)
    bare = path.with_suffix("") if path.suffix in (".vd1", ".vd2") else path
    for folder in (Path(), VIDEOS, DATA):
        if (folder / bare.parent / f"{bare.name}.vd1").is_file():
            return folder / bare
    raise InputError(f"no such movie: neither {bare}.vd1 nor {VIDEOS / bare}.vd1", file=name)


def _found(name: str, folders: tuple[Path, ...], suffix: str, what: str) -> Path:
    tried = [folder / named for folder in folders for named in (name, name + suffix)]
    for path in tried:
        try:
            if path.is_file():
                return path
        except (OSError, ValueError):
            break
    elsewhere = " or ".join(f"{folder}/" for folder in folders[1:])
    raise InputError(f"no such {what}, nor in {elsewhere}", file=name)
