"""The frames of a film as tasks."""

from __future__ import annotations

import hashlib
import os
import pickle
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

from vectorplot.batch.tasks import Task, fingerprint
from vectorplot.errors import InputError
from vectorplot.film import Film
from vectorplot.save import FORMATS, write
from vectorplot.save_frames import DIGITS

_PICKLE = 5
"""The protocol in which films are compared: any one, but always the same."""


def frame_tasks(film: Film, folder: str | os.PathLike[str], *, format: str | None = None) -> Iterator[Task]:
    """The files that `vp.save_frames` would write into a folder, as tasks, one by one.

    Parameters
    ----------
    film : Film
        As of `vp.animate`.
    folder : str or path
        Where they go.
    format : str, optional
        svg for drawings and png for pixels where None.

    Returns
    -------
    iterator of Task
        0001.svg and so on, with fingerprints where the film can be pickled, as those of animation files can. Others are
        always made, and in this process.

    Raises
    ------
    InputError
        For an unknown format.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.batch import frame_tasks
    >>> from vectorplot.geometry import box
    >>> die = vp.Item("die", box((1, 1, 1)))
    >>> film = vp.animate(vp.Animation(lambda time: die.turned("z", 90 * time), frames=3), page="100x80")
    >>> [task.path for task in frame_tasks(film, "frames")]
    ['frames/0001.svg', 'frames/0002.svg', 'frames/0003.svg']
    """
    written = format or ("png" if film.pixels else "svg")
    if written not in FORMATS:
        raise InputError(f"unknown format {written!r}; known are {', '.join(FORMATS)}")
    # Neither the order of options, nor the number of threads, nor who is told of the stages changes a frame.
    options = {name: value for name, value in sorted(film.options.items()) if name not in ("jobs", "explain")}
    same = replace(film, options=options)
    try:
        whole = hashlib.sha256(pickle.dumps(same, _PICKLE)).hexdigest()
    except (pickle.PicklingError, AttributeError, TypeError):
        whole = ""
    for frame in range(len(film)):
        path = os.fspath(Path(folder) / f"{frame + 1:0{DIGITS}d}.{written}")
        known = fingerprint(whole, str(frame), written) if whole else ""
        yield Task(path, partial(frame_content, film, frame, written), known)


def frame_content(film: Film, frame: int, format: str) -> bytes:
    """A frame as the content of a file."""
    return write(film.picture(frame), format)
