"""Options for camera and page, and what becomes of them; the scene file's own are the defaults, field by field."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.options import at_least, between, chosen, exclusive, length, number, page_size, point, upwards

if TYPE_CHECKING:
    from vectorplot.geometry.cameras.camera import Camera, Point
    from vectorplot.scene.pages.page import Page
    from vectorplot.scene.scene import Scene

Command = Callable[..., None]

VIEW_WORDS = ("front", "back", "left", "right", "top", "bottom", "iso")

CAMERA_OPTIONS = (
    click.option("--eye", type=point, metavar="X,Y,Z", help="Where one looks from."),
    click.option("--target", type=point, metavar="X,Y,Z", help="What one looks at."),
    click.option("--up", type=upwards, metavar="X,Y,Z", help="What is upwards, or x, y, z (default: z)."),
    click.option("--twist", type=number, metavar="DEG", help="Turn of the camera about its principal ray."),
    click.option("--fov", type=between(0.0, 180.0), metavar="DEG", help="Full angle over the picture height."),
    click.option("--parallel", is_flag=True, help="Parallel projection along eye - target."),
    click.option(
        "--height", type=between(0.0, math.inf), metavar="H", help="World units over the page, when parallel."
    ),
    click.option("--near", type=between(0.0, math.inf), metavar="D", help="What is nearer to the eye is cut off."),
    click.option("--far", type=between(0.0, math.inf), metavar="D", help="What is farther from the eye is cut off."),
    click.option(
        "--view",
        type=click.Choice(VIEW_WORDS),
        help="A main view of what stands along --up in place of --eye, parallel unless --fov is given.",
    ),
)


def fit_option(filled: str) -> Callable[[Command], Command]:
    """``--fit`` and ``--no-fit``, with what a fitted picture fills."""
    return click.option("--fit/--no-fit", default=True, help=f"Fill the {filled}, or keep the camera's scale.")


LANDSCAPE = click.option("--landscape", is_flag=True, help="Lay the page on its longer side.")
"""Of whatever has a page."""

PAGE_OPTIONS = (
    click.option(
        "--page",
        type=page_size,
        metavar="SIZE",
        help="A0 to A6, letter, legal, ... or WIDTHxHEIGHT in mm; fit: as large as the picture.  [default: A4]",
    ),
    click.option(
        "--width", type=length, metavar="LENGTH", help="Of a page as high as its picture: 80mm, 8cm, 3in or 120pt."
    ),
    LANDSCAPE,
    click.option("--margin", type=at_least(0.0), metavar="MM", help="Empty border of the page.  [default: 10]"),
    fit_option("page"),
)


@dataclass(frozen=True)
class CameraOptions:
    """What the user said about the camera; None and False: nothing."""

    eye: Point | None = None
    target: Point | None = None
    up: Point | None = None
    twist: float | None = None
    fov: float | None = None
    parallel: bool = False
    height: float | None = None
    near: float | None = None
    far: float | None = None
    view: str | None = None

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> CameraOptions:
        """What a command with CAMERA_OPTIONS was told. Bad usage for options that contradict each other."""
        found = cls(**{field.name: options[field.name] for field in fields(cls)})
        found.check()
        return found

    def says_where(self) -> bool:
        """Whether the user said where one looks from, or what is up."""
        return any(one is not None for one in (self.eye, self.up, self.twist, self.view))

    def check(self) -> None:
        """Bad usage for options that contradict each other."""
        exclusive([("--up", self.up), ("--twist", self.twist)])
        exclusive([("--fov", self.fov), ("--parallel", self.parallel)])
        exclusive([("--fov", self.fov), ("--height", self.height)])
        exclusive([("--view", self.view), ("--eye", self.eye)])


@dataclass(frozen=True)
class PageOptions:
    """What the user said about the page; None and False: nothing. page: width and height in mm, or a word."""

    page: tuple[float, float] | str | None = None
    landscape: bool = False
    margin: float | None = None

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> PageOptions:
        """What a command with PAGE_OPTIONS was told. Bad usage for a page of a size and a width."""
        size = None if isinstance(options["page"], str) else options["page"]
        exclusive([("--page SIZE", size), ("--width", options.get("width"))])
        return cls(**{field.name: options[field.name] for field in fields(cls)})


def camera_from(options: CameraOptions, scene: Scene) -> Camera:
    """The camera of the scene (or the default one) with the user's fields in place of its own.

    An InputWarning says where its field of vision will not look natural.
    """
    from vectorplot.errors import InputWarning
    from vectorplot.geometry.cameras.camera import Camera
    from vectorplot.geometry.cameras.lens import lens_advice
    from vectorplot.scene.point_of_view import default_camera

    upright = chosen(options.up, (0.0, 0.0, 1.0))
    base = scene.camera or default_camera(scene, upright)
    if options.view is not None:
        named = Camera.view(options.view, chosen(options.target, base.target), base.distance, upright)
        height = base.height if base.parallel else None
        base = replace(named, fov_deg=base.fov_deg, height=height, near=base.near, far=base.far)
    parallel = options.parallel or (base.parallel and options.fov is None)
    if options.height is not None and not parallel:
        raise click.UsageError("--height needs --parallel")
    camera = replace(
        base,
        eye=chosen(options.eye, base.eye),
        target=chosen(options.target, base.target),
        up=base.up if options.view is not None else chosen(options.up, base.up),
        twist_deg=chosen(options.twist, base.twist_deg),
        fov_deg=chosen(options.fov, base.fov_deg),
        parallel=parallel,
        height=chosen(options.height, base.height) if parallel else None,
        near=chosen(options.near, base.near),
        far=chosen(options.far, base.far),
    )
    told = None if parallel else lens_advice(camera.fov_deg)
    if told is not None:
        warnings.warn(told, InputWarning, stacklevel=2)
    return camera


def page_from(options: PageOptions, scene: Scene) -> Page:
    """The page of the scene (or A4) with the user's size, margin and orientation; bad usage if nothing is left."""
    from vectorplot.errors import InputError
    from vectorplot.scene.pages.fitted_pages import FittedPage, PageOfWidth, fitted_page, page_of_width
    from vectorplot.scene.pages.page import Page

    base = chosen(scene.page, Page())
    own = (base.width_mm, base.height_mm)
    width, height = own if options.page is None or isinstance(options.page, str) else options.page
    try:
        page = Page(width, height, chosen(options.margin, base.margin_mm))
    except InputError as error:
        raise click.UsageError(str(error)) from None
    page = page.landscape if options.landscape else page
    if options.page is None and isinstance(base, PageOfWidth):
        return page_of_width(page, base.width_mm)
    fitted = isinstance(options.page, str) or (options.page is None and isinstance(base, FittedPage))
    return fitted_page(page) if fitted else page
