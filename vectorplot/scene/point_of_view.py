"""From where a scene is looked at, and on what page, where that is said in a word or not at all."""

from __future__ import annotations

import math

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.camera import VIEWS, Camera, Point
from vectorplot.geometry.rotations import upright_turn
from vectorplot.geometry.vectors import normalize
from vectorplot.scene.pages.fitted_pages import FittedPage, PageOfWidth, fitted_page, page_of_width
from vectorplot.scene.pages.page import Page
from vectorplot.scene.pages.paper import FIT, length_mm, sheet_size
from vectorplot.scene.scene import Scene
from vectorplot.words import unknown


def default_camera(scene: Scene, up: Point = (0.0, 0.0, 1.0)) -> Camera:
    """A central projection of the whole scene from the front, the right and above, for what stands upright along up.

    The front of a scene with z upwards is where y is smallest, with y upwards where z is largest.
    """
    return camera_around(scene.bounds, up)


def camera_around(bounds: Floats, up: Point = (0.0, 0.0, 1.0)) -> Camera:
    """The same, of a scene with these bounds (2,3)."""
    low, high = bounds
    centre, size = (low + high) / 2.0, math.dist(low, high)
    direction = normalize(matmul(np.array([0.45, -0.8, 0.45]), upright_turn(up)))
    eye = centre + direction * 2.2 * (size if size > 0.0 else 1.0)
    return Camera(eye=tuple(eye.tolist()), target=tuple(centre.tolist()))


def camera_of(camera: Camera | str | None, scene: Scene) -> Camera:
    """The camera that a scene is looked at with: the one given, the main view of that name with its target in the
    middle of the scene, or that of the scene, else default_camera.

    Errors: InputError for another word, TypeError for what is no camera.
    """
    if camera is None:
        return scene.camera or default_camera(scene)
    if isinstance(camera, Camera):
        return camera
    if not isinstance(camera, str):
        raise TypeError(f"a camera is a Camera or the name of a view, not {type(camera).__name__}")
    if camera not in VIEWS:
        raise unknown("view", camera, VIEWS)
    whole = default_camera(scene)
    return Camera.view(camera, target=whole.target, distance=whole.distance)


def page_of(page: Page | str | None, scene: Scene, width: float | str | None = None, fit: bool = True) -> Page:
    """The page of a picture: the one given, the sheet of that name or size, landscape where that word follows, or that
    of the scene, else A4; of "fit" one of the two latter, cut to the picture. With a width, in mm or as a text with its
    unit, a page as wide, as high as the picture, and with that one's margin.

    fit: the picture is to fill the page.
    Errors: InputError for another word, for what is no width, and for a page cut to a picture that is not to fill it;
    TypeError for what is no page.
    """
    sheet = _sheet_of(page, scene)
    if width is not None:
        sheet = page_of_width(sheet, length_mm(width) if isinstance(width, str) else float(width))
    if not fit and isinstance(sheet, FittedPage | PageOfWidth):
        raise InputError("a page as large as its picture, or of a width, does not go with no-fit")
    return sheet


def _sheet_of(page: Page | str | None, scene: Scene) -> Page:
    if page is None:
        return scene.page or Page()
    if isinstance(page, Page):
        return page
    if not isinstance(page, str):
        raise TypeError(f"a page is a Page or a text such as 'A4', '200x150' or 'fit', not {type(page).__name__}")
    sheet, _, way = page.strip().partition(" ")
    if (way := way.strip().lower()) not in ("", "landscape", "portrait"):
        raise InputError(f"page {page!r}: expected a sheet, and perhaps 'landscape' or 'portrait'")
    fitted = sheet.lower() == FIT
    found = (scene.page or Page()) if fitted else Page(*sheet_size(sheet))
    found = found.landscape if way == "landscape" else found.portrait if way == "portrait" else found
    return fitted_page(found) if fitted else found
