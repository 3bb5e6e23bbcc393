"""Where data files, animation files and movies lie, and what they are called where only a part of the name is given.

Source: Glaeser, appendix A.1 to A.3.
"""

from __future__ import annotations

from pathlib import Path

from vectorplot.errors import InputError

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
