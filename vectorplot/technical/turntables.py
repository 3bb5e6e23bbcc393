"""A scene on a turntable: drawings from all around at one scale."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np

from vectorplot.batch.calls import Submits
from vectorplot.batch.running import results
from vectorplot.draw import draw
from vectorplot.drawing.drawing import Drawing
from vectorplot.errors import InputError
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.io.anything import scene_of
from vectorplot.scene.cuts.exploded import shown_apart
from vectorplot.scene.pages.page import Page
from vectorplot.scene.point_of_view import page_of

MOST = 1000
"""Drawings of one turntable."""

DISTANCE = 4.0
"""From the eye to the middle of the scene, in radii of the ball around it."""

USUAL_PAGE = Page(80.0, 80.0, 2.0)


def turntable(
    scene: object,
    count: int = 8,
    *,
    elevation_deg: float = 25.0,
    page: Page | str = USUAL_PAGE,
    executor: Submits | None = None,
    **options: Any,
) -> tuple[Drawing, ...]:
    """Drawings of a scene that turns about its vertical axis, clockwise from above, all at one scale.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, curve, or several of these
        As of draw.
    count : int
        How many, a whole turn in equal steps; 1 to 1000.
    elevation_deg : float
        How high the eye stands above the horizon, -89 to 89 degrees.
    page : Page or str
        Of each drawing, as of draw.
    executor : Executor, optional
        Whose workers make the drawings, as of `batch.run`; where None, they are made one after another.
    options : Any
        Others as of draw, but for camera and fit.

    Returns
    -------
    tuple of Drawing
        The first one from the front.

    Raises
    ------
    InputError
        For another count or elevation, and as of draw.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.surfaces import Torus
    >>> views = vp.turntable(Torus(3, 1), 4)
    >>> len(views), vp.contact_sheet(views).width_mm
    (4, 210.0)
    """
    if not 1 <= count <= MOST:
        raise InputError(f"a turntable of {count} drawings: expected 1 to {MOST}")
    if not abs(elevation_deg) <= 89.0:
        raise InputError(f"a turntable seen from {elevation_deg:g} degrees above: expected -89 to 89")
    shown = shown_apart(scene_of(scene))
    low, high = shown.bounds
    middle, radius = 0.5 * (low + high), 0.5 * math.dist(low, high) or 1.0
    paper = page_of(page, shown)
    # The whole page shows as much more than what its margin leaves as it is larger.
    width, height = paper.room
    share = min(width, height) / paper.height_mm
    fov = 2.0 * math.degrees(math.atan(math.tan(math.asin(1.0 / DISTANCE)) / share))
    above = math.radians(elevation_deg)
    turn = 2.0 * np.pi * np.arange(count) / count
    ways = np.stack([np.sin(turn), -np.cos(turn), np.full(count, math.tan(above))], axis=1) * math.cos(above)
    eyes = (middle + DISTANCE * radius * ways).tolist()
    target = (float(middle[0]), float(middle[1]), float(middle[2]))
    cameras = [Camera((x, y, z), target, fov_deg=fov) for x, y, z in eyes]
    calls = [partial(draw, shown, camera, page=paper, fit=False, **options) for camera in cameras]
    return tuple(call() for call in calls) if executor is None else tuple(results(calls, executor))
