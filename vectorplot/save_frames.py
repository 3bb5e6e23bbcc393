"""Frames in one file that moves, in the pages of one file, or in a folder with a file for each."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from vectorplot.animation.animation import check_fps
from vectorplot.drawing.drawing import Drawing
from vectorplot.errors import InputError
from vectorplot.save import FORMATS, Destination, format_for, name_of, put, write, write_together, write_whole
from vectorplot.shading.image import Bytes, Image

if TYPE_CHECKING:
    from vectorplot.animation.movies import Movie


VIDEOS = ("mp4", "webm", "gif")
"""Formats of pixels, through the package av."""

ONE_FILE = ("pdf", "svg", *VIDEOS)
"""The formats of all frames together."""

MOVIES = ("vd1", "vd2")
"""The suffixes of the two files that hold a movie as polygons."""

DIGITS = 4
"""Of the numbers of frames in a folder, at least: so they stand in their order."""

Picture = Drawing | Image


def save_frames(
    pictures: Iterable[Picture],
    path: Destination,
    *,
    fps: float = 25.0,
    format: str | None = None,
) -> None:
    """Write frames as one file, as the two files of a movie, or into a folder.

    Parameters
    ----------
    pictures : iterable of Drawing or Image
        The frames in their order; each is made, written and forgotten before the next one.
    path : str, path or file object
        A name that ends in .pdf (a page for each frame), .svg (it moves by itself), .mp4, .webm, .gif (a video), .vd1
        or .vd2 (a movie of polygons, both files); any other one is a folder with a file for each frame, which is made
        where there is none. Or an open file, which takes pdf, svg and videos; it is not closed.
    fps : float
        Frames a second.
    format : str, optional
        Of the files in a folder; svg for drawings and png for pixels where None. Of an open file: pdf, svg, mp4, webm
        or gif.

    Raises
    ------
    InputError
        For pixels in formats of drawings, unknown formats, an open file without a format, and videos where the package
        av is not installed.
    OSError
        Where a file cannot be written; it names the path.

    Notes
    -----
    A file is written whole or not at all, and so are the two of a movie; of a folder each file is. Videos have 150 dots
    per inch.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import vectorplot as vp
    >>> pages = [vp.Drawing(100, 80, ()), vp.Drawing(100, 80, ())]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     vp.save_frames(pages, pathlib.Path(folder, "frames"))
    ...     sorted(path.name for path in pathlib.Path(folder, "frames").iterdir())
    ['0001.svg', '0002.svg']
    """
    check_fps(fps)
    name = name_of(path)
    kind = _kind_in_file(format_for(path, format).lower()) if name is None else kind_of(name)
    if name is None or kind in ONE_FILE:
        put(path, write_frames(pictures, kind, fps))
    elif kind == "folder":
        _save_folder(pictures, Path(name), format)
    else:
        from vectorplot.animation.movies import movie_of

        save_movie(movie_of(_drawings(pictures, "a movie of polygons")), Path(name).with_suffix(""))


def save_movie(movie: Movie, path: Path) -> None:
    """Write the two files of a movie, whose name without suffix is given: both, or none."""
    from vectorplot.animation.movies import encoded

    first, second = encoded(movie)
    # The first one is what a movie is found by.
    write_together({path.with_name(path.name + ".vd2"): second, path.with_name(path.name + ".vd1"): first})


def recorded(pictures: Iterable[Picture], path: Path) -> Iterator[Drawing]:
    """The drawings, which are recorded while they go by, and saved as a movie of this name behind the last one."""
    from vectorplot.animation.movies import Recorder

    recorder = Recorder()
    for drawing in _drawings(pictures, "a movie of polygons"):
        recorder.add(drawing)
        yield drawing
    save_movie(recorder.movie(), path)


def kind_of(path: str | os.PathLike[str]) -> str:
    """What frames become under a name: one of ONE_FILE or MOVIES, or ``folder``.

    Errors: InputError for the suffix of a picture that cannot hold several.
    """
    text = os.fspath(path)
    suffix = Path(text).suffix[1:].lower()
    if text.endswith(("/", os.sep)) or Path(text).is_dir() or not suffix:
        return "folder"
    if suffix in (*ONE_FILE, *MOVIES):
        return suffix
    known = ", ".join(f".{one}" for one in (*ONE_FILE, MOVIES[0]))
    raise InputError(f"{text}: frames are written as {known}, or into a folder, whose name ends in /")


def _kind_in_file(format: str) -> str:
    """The format, one of ONE_FILE. Errors: InputError for another one."""
    if format not in ONE_FILE:
        why = "a movie of polygons is two files, and needs a path" if format in MOVIES else "unknown to films"
        raise InputError(f"{format}: {why}; an open file takes {', '.join(ONE_FILE)}")
    return format


def write_frames(pictures: Iterable[Picture], format: str, fps: float) -> bytes:
    """Frames as the content of one file of a format of ONE_FILE. Errors: see save_frames."""
    if format in VIDEOS:
        from vectorplot.backends.video import video_bytes

        return video_bytes(map(pixels_of, pictures), fps, format)
    frames = _drawings(pictures, f"a file of the format {format}")
    first = next(frames, None)
    title = "" if first is None else first.title
    every = _with(first, frames)
    if format == "pdf":
        from vectorplot.backends.cairo import pdf_pages_bytes

        return pdf_pages_bytes(every, title)
    from vectorplot.backends.svg import animated_svg_bytes

    return animated_svg_bytes(every, fps, title)


def pixels_of(picture: Picture) -> Bytes:
    """(rows, columns, 3) the pixels of a frame; of a drawing at 150 dots per inch."""
    if isinstance(picture, Image):
        return picture.pixels
    from vectorplot.backends.cairo import drawing_pixels

    return drawing_pixels(picture)


def _save_folder(pictures: Iterable[Picture], folder: Path, format: str | None) -> None:
    if format is not None and format not in FORMATS:
        raise InputError(f"unknown format {format!r}; known are {', '.join(FORMATS)}")
    for number, picture in enumerate(pictures, start=1):
        word = format or ("png" if isinstance(picture, Image) else "svg")
        content = write(picture, word)
        folder.mkdir(exist_ok=True)
        write_whole(folder / f"{number:0{DIGITS}d}.{word}", content)


def _drawings(pictures: Iterable[Picture], what: str) -> Iterator[Drawing]:
    for picture in pictures:
        if isinstance(picture, Image):
            raise InputError(f"frames of pixels do not go into {what}: write a video, or a folder")
        yield picture


def _with(first: Drawing | None, rest: Iterator[Drawing]) -> Iterator[Drawing]:
    if first is not None:
        yield first
        yield from rest


def told(pictures: Iterable[Picture], count: int, progress: Callable[[str, float], None] | None) -> Iterator[Picture]:
    """The pictures; progress("frames", fraction) is called before each of so many."""
    for number, picture in enumerate(pictures):
        if progress is not None:
            progress("frames", (number + 1) / max(count, 1))
        yield picture
