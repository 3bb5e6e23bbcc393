"""Where the picture stands on its page, pages as large as their picture, and cameras and pages said in words."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import VIEWS, Camera, Point
from vectorplot.geometry.projections import Projection
from vectorplot.geometry.rotations import upright_turn
from vectorplot.geometry.vectors import normalize
from vectorplot.scene.page import FIT, SCALE, Page, length_mm, scale_ratio, sheet_size
from vectorplot.scene.scene import Scene
from vectorplot.tolerances import FLAT_PICTURE
from vectorplot.words import unknown

# Where the picture goes on the page.


@dataclass(frozen=True, eq=False)
class Placement:
    """Where a picture is on the page.

    projection: that which the picture has: it says what the image is; page: the sheet of paper; page_from_image: (3, 3)
    from homogeneous points (x, y, 1) of the image to mm, y upwards; whole: all of the scene is on the page; filled
    (2,2): the lowest and the highest corner, in the image, of what fills the page, where something does.
    """

    projection: Projection
    page: Page
    page_from_image: Floats
    whole: bool
    filled: Floats | None = None

    @property
    def scale(self) -> float:
        """How many mm a unit of the image is on the page."""
        return float(self.page_from_image[0, 0])

    @property
    def window(self) -> tuple[Floats, Floats]:
        """The corners (2,) of the page inside its margin, in the image: left and bottom, right and top."""
        middle, size = self.page_from_image[:2, 2], np.array([self.page.width_mm, self.page.height_mm])
        return (self.page.margin_mm - middle) / self.scale, (size - self.page.margin_mm - middle) / self.scale

    @cached_property
    def page_from_world(self) -> Floats:
        """(4,4) matrix from points (x,y,z,1) of the world to homogeneous points of the page in mm; the third row keeps
        z."""
        unit = 1.0 / self.projection.scale
        rows = matmul(matmul(self.page_from_image, np.diag([unit, unit, 1.0])), self.projection.image_from_world)
        return np.vstack([rows[:2], [0.0, 0.0, 1.0, 0.0], rows[2:]])

    def on_page(self, image: Floats) -> Floats:
        """Points of the image on the page.

        image: (2, n) in units of the image; result: (n, 2) in mm, y upwards.
        """
        return np.asarray((matmul(self.page_from_image[:2, :2], image)).T + self.page_from_image[:2, 2])


def field_of_vision(projection: Projection, page: Page, fit: bool) -> Placement:
    """The place of the camera's field of vision, the target in the middle.

    projection: that of the picture; page: the sheet of paper; fit: the camera's picture height becomes that of the page
    inside its margin; otherwise that of the whole page; result: of a picture that ends at the margins.
    """
    height_mm = page.height_mm - 2.0 * page.margin_mm if fit else page.height_mm
    return Placement(projection, page, centred(page, projection.picture_height, height_mm), whole=False)


def fitted_picture(projection: Projection, page: Page, image: Floats) -> Placement:
    """The place of a picture that fills the page with points of the image.

    image: (2, n) what is inside the margin, in units of the image.
    Edge cases: without points the origin is in the middle; points in one place go to the middle at the scale 1; those
    on a line along the page's width or height fill that.
    """
    if not image.shape[1]:
        return Placement(projection, page, fitted(page, np.zeros(2), np.zeros(2)), whole=True)
    if isinstance(page, PageAtScale) and projection.eye is not None:
        raise InputError("a page at a scale is for parallel projections, such as a main view")
    low, high = image.min(axis=1), image.max(axis=1)
    # Where all sight rays are one the image is a point, and rounding must not fill the page.
    high = high if (high - low).max() > projection.tolerance else low
    scale = page_scale(page, projection)
    scale = fitting_scale(page, high - low) if scale is None else scale
    inside = scale * (high - low)
    sheet = page.around(float(inside[0]), float(inside[1]))
    if not isinstance(page, PageAtScale):
        return Placement(projection, sheet, fitted(sheet, low, high), whole=True, filled=np.stack([low, high]))
    matrix = _in_the_middle(sheet, scale, scale * low, scale * high)
    return Placement(projection, sheet, matrix, whole=True, filled=np.stack([low, high]))


def fitted_with_room(projection: Projection, page: Page, image: Floats, low_mm: Floats, high_mm: Floats) -> Placement:
    """The place of a picture that fills the page with points (2,n) of the image and with room beside them: rectangles
    from low_mm (2,n) to high_mm (2,n), counted from the points on the page.

    Edge cases: see fitted_picture; so it is, without the room, where a page has no place for that at all.
    """
    plain = fitted_picture(projection, page, image)
    most = np.array(page.room)
    scale, beside = plain.scale, (low_mm, high_mm)
    # What a picture takes is a convex function of its scale: Newton's steps come down to the root, one a corner.
    for _ in range(2 * image.shape[1]):
        low, high = _reach(scale, image, *beside)
        lowest, highest = (scale * image + low_mm).argmin(axis=1), (scale * image + high_mm).argmax(axis=1)
        both = np.arange(2)
        slope = image[both, highest] - image[both, lowest]
        over = high - low - most
        steps = [o / s if s > 0.0 else np.inf for o, s in zip(over.tolist(), slope.tolist(), strict=True) if o > 0.0]
        if not steps or scale - max(steps) == scale:
            break
        scale -= max(steps)
        if not scale > 0.0:
            return plain
    low, high = _reach(scale, image, *beside)
    sheet = page.around(*(high - low).tolist())
    return Placement(projection, sheet, _in_the_middle(sheet, scale, low, high), whole=True)


def _in_the_middle(sheet: Page, scale: float, low: Floats, high: Floats) -> Floats:
    """(3,3) matrix from image to page: scaled, the box from low to high (2,) in mm goes to the middle."""
    offset = 0.5 * (np.array([sheet.width_mm, sheet.height_mm]) - low - high)
    return np.array([[scale, 0.0, offset[0]], [0.0, scale, offset[1]], [0.0, 0.0, 1.0]])


def _reach(scale: float, image: Floats, low_mm: Floats, high_mm: Floats) -> tuple[Floats, Floats]:
    """The corners (2,) of what points of the image and rectangles beside them take at a scale."""
    return (scale * image + low_mm).min(axis=1), (scale * image + high_mm).max(axis=1)


def fitted(page: Page, low: Floats, high: Floats) -> Floats:
    """(3,3) matrix from image to page: the box from low to high (2,) fills the page but for its margin, in the middle.

    Edge cases: see fitting_scale; the box goes to the middle.
    """
    scale = fitting_scale(page, high - low)
    middle = np.array([page.width_mm, page.height_mm]) / 2.0
    offset = middle - scale * (low + high) / 2.0
    return np.array([[scale, 0.0, offset[0]], [0.0, scale, offset[1]], [0.0, 0.0, 1.0]])


def fitting_scale(page: Page, size: Floats) -> float:
    """How many mm a unit of the image is where a box of that size (2,) fills the page but for its margin.

    Edge cases: a box without extent has the scale 1; one without width or height fills the other.
    """
    scales = [r / s for r, s in zip(page.room, size.tolist(), strict=True) if s > FLAT_PICTURE * size.max()]
    scale = min(scales, default=1.0)
    if np.isfinite(scale):
        return scale
    # Only a width is asked for, and there is none to be had.
    return float((page.height_mm - 2.0 * page.margin_mm) / size[1])


def centred(page: Page, picture_height: float, height_mm: float) -> Floats:
    """(3,3) matrix from image to page: the image's origin goes to the middle, picture_height becomes height_mm."""
    scale = height_mm / picture_height
    return np.array([[scale, 0.0, page.width_mm / 2.0], [0.0, scale, page.height_mm / 2.0], [0.0, 0.0, 1.0]])


def mm_per_image(projection: Projection, points: Floats, page: Page, fit: bool) -> float:
    """About how many mm a unit of the image will be on the page; points (3,n): of what is seen."""
    if not fit:
        return float(page.height_mm / projection.picture_height)
    if (scale := page_scale(page, projection)) is not None:
        return scale
    if not np.isfinite(points).all():
        points = points.compress(np.isfinite(points).all(axis=0), axis=1)
    every = points.shape[1]
    ahead = projection.depth_of(points) > projection.near
    if not ahead.all():
        points = points.compress(ahead, axis=1)
    if not points.shape[1]:
        return float(page.height_mm / projection.picture_height)
    image = projection.image_of(points)
    fitting = fitting_scale(page, np.ptp(image, axis=1))
    if points.shape[1] == every and not projection.reaches_too_far(points):
        return fitting
    return float(max(fitting, field_of_vision(projection, page, fit).scale))


BESIDE_PICTURE = 0.1
"""The cosine, less than that of any place in a picture, of the angle between a sight line and the middle one."""


def allowed_in_space(
    scene: Scene, projection: Projection, page: Page, fit: bool, tolerance_mm: float
) -> Callable[[Floats], Floats]:
    """How far (...) triangles may be off smooth surfaces at points (..., 3) of the world, so that they are off by no
    more than the tolerance on the page."""
    reached = np.concatenate([scene.vertices, box_corners(scene.bounds)])
    scale = mm_per_image(projection, projection.points_of(reached), page, fit)

    def allowed(points: Floats) -> Floats:
        if projection.eye is None:
            return np.full(points.shape[:-1], tolerance_mm / scale * projection.scale)
        there = projection.points_of(points.reshape(-1, 3))
        depth = np.abs(projection.depth_of(there))
        # What is behind the eye, or far beside the picture, is not seen: there the distance counts.
        away = np.sqrt(((there - np.asarray(projection.eye)[:, None]) ** 2).sum(axis=0))
        ahead = np.maximum(np.maximum(depth, BESIDE_PICTURE * away), projection.near) / projection.focus
        ahead = ahead.reshape(points.shape[:-1])
        return np.asarray(tolerance_mm / scale * projection.scale * ahead)

    return allowed


def box_corners(bounds: Floats) -> Floats:
    """(8,3) the corners of a box from its smallest and largest coordinates (2,3)."""
    low, high = bounds
    return np.asarray(np.where(np.array(list(np.ndindex(2, 2, 2))) == 1, high, low))


# Sheets of paper that are as large as the picture on them, its margin around.

LEAST_MM = 1.0
"""What a picture without width or height, such as a straight line, has for it: a sheet needs both."""


@dataclass(frozen=True)
class FittedPage(Page):
    """A sheet that is cut to the size of its picture, which fills the whole sheet first.

    Pictures of the camera's field of vision, and empty ones, leave it whole.
    """

    def around(self, width_mm: float, height_mm: float) -> Page:
        """The sheet cut to a picture of that size and its margin."""
        border = 2.0 * self.margin_mm
        return Page(max(width_mm, LEAST_MM) + border, max(height_mm, LEAST_MM) + border, self.margin_mm)


@dataclass(frozen=True)
class PageOfWidth(Page):
    """A sheet of a width, and as high as its picture is then.

    Its own height is for pictures of the camera's field of vision, empty ones, and those without width.
    """

    @property
    def room(self) -> tuple[float, float]:
        """Width and height in mm inside the margin: as high as one likes."""
        return self.width_mm - 2.0 * self.margin_mm, math.inf

    def around(self, width_mm: float, height_mm: float) -> Page:
        """The sheet cut to the height of a picture and its margin."""
        return Page(self.width_mm, max(height_mm, LEAST_MM) + 2.0 * self.margin_mm, self.margin_mm)


@dataclass(frozen=True)
class PageAtScale(Page):
    """A sheet cut to its picture, which has so many mm for a unit of the world.

    Its own size is for empty pictures.
    """

    mm_per_unit: float = 1.0

    @property
    def room(self) -> tuple[float, float]:
        """Width and height in mm inside the margin: as large as one likes."""
        return math.inf, math.inf

    def around(self, width_mm: float, height_mm: float) -> Page:
        """The sheet cut to a picture and its margin."""
        return fitted_page(self).around(width_mm, height_mm)


def page_scale(page: Page, projection: Projection) -> float | None:
    """How many mm a unit of the image is on a page that has a scale; None on others."""
    return page.mm_per_unit * projection.scale if isinstance(page, PageAtScale) else None


def page_at_scale(sheet: Page, text: str) -> PageAtScale:
    """A sheet that is to be cut to its picture at a scale, see scale_ratio, with the margin of another one."""
    paper, world = scale_ratio(text)
    return PageAtScale(sheet.width_mm, sheet.height_mm, sheet.margin_mm, paper / world)


def fitted_page(sheet: Page) -> FittedPage:
    """A sheet that is to be cut to the size of its picture."""
    return FittedPage(sheet.width_mm, sheet.height_mm, sheet.margin_mm)


def page_of_width(sheet: Page, width_mm: float) -> PageOfWidth:
    """A sheet of a width; of another one it has the margin, and the proportions inside it.

    Errors: InputError for a width that is not finite and positive, or that the margin leaves nothing of.
    """
    border = 2.0 * sheet.margin_mm
    height = max(width_mm - border, 0.0) * (sheet.height_mm - border) / (sheet.width_mm - border) + border
    # Where margins leave nothing, the width is to be told, not the height.
    return PageOfWidth(width_mm, height if width_mm > border else width_mm, sheet.margin_mm)


# From where a scene is looked at, and on what page, where that is said in a word or not at all.


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
    """The page of a picture: the given one, the named sheet or size (landscape on that word), the scene's, or A4;
    "fit": one of the last two, cut to the picture. width: in mm or with a unit: a page so wide, as high as the
    picture, with that one's margin. fit: whether the picture fills the page.
    Errors: InputError for unknown words and widths, and for "fit" where the picture does not fill the page; TypeError
    for no page.
    """
    sheet = _sheet_of(page, scene)
    if width is not None:
        sheet = page_of_width(sheet, length_mm(width) if isinstance(width, str) else width)
    if not fit and isinstance(sheet, FittedPage | PageOfWidth | PageAtScale):
        raise InputError("a page as large as its picture, of a width or at a scale does not go with no-fit")
    return sheet


def _sheet_of(page: Page | str | None, scene: Scene) -> Page:
    if page is None:
        return scene.page or Page()
    if isinstance(page, Page):
        return page
    if not isinstance(page, str):
        raise TypeError(f"a page is a Page or a text such as 'A4', '200x150' or 'fit', not {type(page).__name__}")
    sheet, _, way = page.strip().partition(" ")
    if sheet.lower() == SCALE:
        return page_at_scale(scene.page or Page(), way)
    if (way := way.strip().lower()) not in ("", "landscape", "portrait"):
        raise InputError(f"page {page!r}: expected a sheet, and perhaps 'landscape' or 'portrait'")
    fitted = sheet.lower() == FIT
    found = (scene.page or Page()) if fitted else Page(*sheet_size(sheet))
    found = found.landscape if way == "landscape" else found.portrait if way == "portrait" else found
    return fitted_page(found) if fitted else found
