"""From options to a camera and a page; the scene file's own are the defaults, field by field."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import click

from vectorplot.cli.options import chosen, exclusive

if TYPE_CHECKING:
    from vectorplot.geometry.camera import Camera, Point
    from vectorplot.scene.scene import Page, Scene


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
    view: str | None = None

    def check(self) -> None:
        """Bad usage for options that contradict each other."""
        exclusive([("--up", self.up), ("--twist", self.twist)])
        exclusive([("--fov", self.fov), ("--parallel", self.parallel)])
        exclusive([("--fov", self.fov), ("--height", self.height)])
        exclusive([("--view", self.view), ("--eye", self.eye)])


def camera_from(options: CameraOptions, scene: Scene) -> Camera:
    """The camera of the scene (or the default one) with the user's fields in place of its own."""
    from vectorplot.draw import default_camera
    from vectorplot.geometry.camera import Camera

    base = default_camera(scene) if scene.camera is None else scene.camera
    if options.view is not None:
        named = Camera.view(options.view, target=chosen(options.target, base.target), distance=base.distance)
        height = base.height if base.parallel else None
        base = replace(named, fov_deg=base.fov_deg, height=height)
    parallel = options.parallel or (base.parallel and options.fov is None)
    if options.height is not None and not parallel:
        raise click.UsageError("--height needs --parallel")
    return replace(
        base,
        eye=chosen(options.eye, base.eye),
        target=chosen(options.target, base.target),
        up=chosen(options.up, base.up),
        twist_deg=chosen(options.twist, base.twist_deg),
        fov_deg=chosen(options.fov, base.fov_deg),
        parallel=parallel,
        height=chosen(options.height, base.height) if parallel else None,
    )


def page_from(size: tuple[float, float] | None, landscape: bool, margin: float | None, scene: Scene) -> Page:
    """The page of the scene (or A4) with the user's size, margin and orientation; bad usage if nothing is left."""
    from vectorplot.errors import InputError
    from vectorplot.scene.scene import Page

    base = chosen(scene.page, Page())
    width, height = chosen(size, (base.width_mm, base.height_mm))
    try:
        page = Page(width, height, chosen(margin, base.margin_mm))
    except InputError as error:
        raise click.UsageError(str(error)) from None
    return page.landscape if landscape else page
