"""The files that a scene file may name: meshes, parts of CAD systems, and other scenes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from vectorplot.errors import InputError
from vectorplot.io.mesh_file import check_file
from vectorplot.io.scene_words import Words

DEEPEST = 16
"""So many scene files may include one another in a row."""

CAD_SUFFIXES = (".step", ".stp", ".iges", ".igs", ".brep")
"""Files of CAD systems."""

NO_PARTS = f"a way of drawing parts is for CAD parts only ({', '.join(CAD_SUFFIXES)})"
"""What is said where it is asked for in a file without any."""

MOST_FILES = 1000
"""So many files a scene may be made of."""


@dataclass(frozen=True)
class NamedFiles:
    """Where the names of files in a scene file lead to.

    root: the folder of the file that the user named, out of which nothing is read; chain: the files that include one
    another, the one that is read last; tolerance, parts: of CAD parts among them, see cad_files.cad_scene, None for the
    usual ones; opened: all that were read, which grows.
    """

    root: Path
    chain: tuple[Path, ...]
    tolerance: float | None = None
    parts: str | None = None
    opened: list[Path] = field(default_factory=list)

    @classmethod
    def of(cls, path: Path, tolerance: float | None = None, parts: str | None = None) -> NamedFiles:
        """Those of a file that the user named."""
        found = path.resolve()
        return cls(found.parent, (found,), tolerance, parts)

    @property
    def has_parts(self) -> bool:
        """Whether CAD parts are among those that were read."""
        return any(path.suffix.lower() in CAD_SUFFIXES for path in self.opened)

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
# Names are found whatever their capitals: those of the book are all in capitals.
#
# Source: Glaeser, appendix A.1 to A.3.

DATA, ANIMATIONS, VIDEOS = Path("data"), Path("anim"), Path("video")
"""The folders, beside each other in the current one."""

SCENE, ANIMATION = ".scene", ".anim"
"""Suffixes that may be left out."""

VIDEO = VIDEOS / "tmp"
"""The name of a movie that has none."""


def samples() -> Path:
    """The folder of the data files that come with the package: data/ of the checkout, or what a wheel makes of it."""
    package = Path(__file__).parents[1]
    installed = package / "samples"
    return installed if installed.is_dir() else package.parent / DATA


def data_file(name: str) -> Path:
    """The data file of a name: in the current folder, then in DATA, then among the samples; as it is, then with the
    suffix SCENE.

    Errors: InputError where there is none.
    """
    found = _found(name, (Path(), DATA), ("", SCENE))
    if found is None:
        raise InputError(f"no such data file, nor in {DATA}/", file=name)
    return found


def data_file_or_name(name: str) -> str:
    """The data file of a name; the name itself where there is none, which whoever opens it will say."""
    try:
        return str(data_file(name))
    except InputError:
        return name


def animation_file(name: str) -> Path:
    """The animation file of a name: in the current folder, then in ANIMATIONS, in DATA and among the samples; as it
    is, then with the suffix ANIMATION.

    Errors: InputError where there is none.
    """
    found = _found(name, (Path(), ANIMATIONS, DATA), ("", ANIMATION))
    if found is None:
        raise InputError(f"no such animation file, nor in {ANIMATIONS}/ or {DATA}/", file=name)
    return found


def movie_to_write(name: str | None) -> Path:
    """The movie of a name without suffix: a name alone lies in VIDEOS; None is VIDEO."""
    path = VIDEO if name is None else Path(name)
    return VIDEOS / path if path.parent == Path() and not path.is_absolute() else path


def movie_to_read(name: str) -> Path:
    """The movie of a name, with or without a suffix: in the current folder, then in VIDEOS, in DATA and among the
    samples.

    Errors: InputError where there is none.
    """
    path = Path(name)
    bare = path.with_suffix("") if path.suffix.lower() in (".vd1", ".vd2") else path
    found = _found(str(bare), (Path(), VIDEOS, DATA), (".vd1",))
    if found is None:
        raise InputError(f"no such movie: neither {bare}.vd1 nor {VIDEOS / bare}.vd1", file=name)
    return found.with_suffix("")


def _found(name: str, folders: Sequence[Path], suffixes: Sequence[str]) -> Path | None:
    """The first file of a name, with one of the suffixes, in one of the folders or among the samples."""
    inside = Path(name).parts
    sample = samples().joinpath(*(inside[1:] if inside and inside[0].lower() == str(DATA) else inside))
    try:
        for path in (*(folder / name for folder in folders), sample):
            for suffix in suffixes:
                file = _in_any_case(Path(f"{path}{suffix}"))
                if file is not None and file.is_file():
                    return file
    except (OSError, ValueError):
        # No file can be called so.
        return None
    return None


def _in_any_case(path: Path) -> Path | None:
    """What is called so; where there is no such thing, the first that is called so but for capitals."""
    if path.exists() or path == path.parent:
        return path
    folder = _in_any_case(path.parent)
    if folder is None or not folder.is_dir():
        return None
    return min((one for one in folder.iterdir() if one.name.lower() == path.name.lower()), default=None)
