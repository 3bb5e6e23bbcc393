"""A scene in a notebook, turned by mouse and keys."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from vectorplot.errors import not_installed
from vectorplot.io.anything import scene_of
from vectorplot.viewer.pictures import Given, Source

if TYPE_CHECKING:
    from vectorplot.viewer.widget import ViewerWidget


def show(scene: object) -> ViewerWidget:
    """A widget in which a scene is turned by mouse and keys, and drawn exactly when it is still.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, curve, mesh of another library, arrays, or several of these
        As all verbs take it. A scene file can be edited beside its picture.

    Returns
    -------
    ViewerWidget
        The page of `vectorplot try`, for the last line of a cell in Jupyter, VS Code and what else anywidget knows.
        Its `state` follows what is seen, and can be set; `picture()` gives the drawing.

    Raises
    ------
    InputError
        Where anywidget is not installed, and as in `io.scene_of`.
    TypeError
        For what has no shape.

    Notes
    -----
    The kernel makes pictures in threads of its own: cells go on meanwhile. What nobody waits for any more stops.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> widget = vp.show(box((1, 1, 1)))
    >>> widget.picture().width_mm
    297.0
    """
    try:
        from vectorplot.viewer.widget import ViewerWidget
    except ImportError:
        raise not_installed("show", "anywidget", "notebook") from None
    if isinstance(scene, str | os.PathLike):
        source = Source(Path(scene))
        source.scene(None)
        return ViewerWidget(source)
    return ViewerWidget(Given(scene_of(scene)))
