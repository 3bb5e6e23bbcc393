"""Why a picture shows nothing, and what would show something."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.effects.cuts import cut_scene, depths
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.projections import projection_of
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.page import Page
from vectorplot.scene.placement import box_corners, camera_of, default_camera, field_of_vision
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.surface import is_parametrised
from vectorplot.tolerances import ZERO_OF_EXTENT

_FEATURES = "contour,boundary,crease,intersection"
"""What nearly every shape has some of."""


def why_nothing(
    scene: Scene, camera: Camera | None, page: Page, *, fit: bool = True, lines: Iterable[str] | None = None
) -> str:
    """Why the picture of a scene shows nothing, and what to type, in words that follow a colon.

    page: of a picture of pixels one of its proportions; lines: the kinds that were asked for, None where nobody did.
    """
    if not scene.items:
        return "there is nothing in it: a line such as 'CUBE blue box 1 1 1' makes a shape"
    seen = camera_of(camera, scene)
    low, high = scene.bounds
    lies = f"all lies between {_spelled(low)} and {_spelled(high)}"
    points = _reached(scene)
    if not len(points):
        return "its items have no faces"
    near, far = (limit(depths(points, seen)) for limit in (np.min, np.max))
    if not seen.parallel and far <= 0.0:
        looks = f"it looks from {_spelled(seen.eye)} to {_spelled(seen.target)}, and {lies}"
        return f"everything is behind the eye: {looks}; try --target {_spelled((low + high) / 2.0)}"
    away = f"{near:.4g} to {far:.4g} away; leave out --{{0}}, or {{0}} of the scene's camera"
    if seen.near is not None and far <= seen.near:
        return f"everything is nearer than {seen.near:g}, {away.format('near')}"
    if seen.far is not None and near >= seen.far:
        return f"everything is farther than {seen.far:g}, {away.format('far')}"
    if scene.cuts and not len(_reached(cut_scene(scene, seen))):
        return f"all is cut away: {lies}; try another --cut"
    beside = _beside(points, scene, seen, page, fit)
    if beside is not None:
        middle = f"--target {_spelled((low + high) / 2.0)}"
        return f"everything is {beside} the page: {lies}; try {'' if fit else '--fit, or '}{middle}"
    if not seen.parallel and ((low < seen.eye) & (seen.eye < high)).all():
        outside = _spelled(default_camera(scene).eye)
        return f"the eye, {_spelled(seen.eye)}, is amid what it looks at: {lies}; try --eye {outside}"
    if _edge_on(scene, seen):
        return "it is flat, and seen from its edge; try another --eye"
    if lines is not None:
        return f"no lines of the kinds asked for ({', '.join(lines) or 'none'}) are seen; try --lines {_FEATURES}"
    return "all of it is hidden, or has nothing that shows; try draw --style wireframe"


def _reached(scene: Scene) -> Floats:
    """(n,3) points between which all that could be seen lies."""
    shapes = [item.shape for item in scene.items]
    meshes = [shape.vertices[shape.corners] for shape in shapes if isinstance(shape, Mesh)]
    smooth = [box_corners(smooth_bounds(shape)) for shape in shapes if not isinstance(shape, Mesh)]
    return np.concatenate(meshes + smooth)


def _beside(points: Floats, scene: Scene, camera: Camera, page: Page, fit: bool) -> str | None:
    """On which side of the page all points are that are before the eye; None where that is on none."""
    projection = projection_of(camera, scene.bounds)
    inside = projection.points_of(points)
    inside = inside[:, projection.depth_of(inside) > projection.near]
    if not inside.shape[1] or (fit and not projection.reaches_too_far(projection.points_of(points))):
        return None
    image, (low, high) = projection.image_of(inside), field_of_vision(projection, page, fit).window
    left, below = (image.max(axis=1) <= low).tolist()
    right, above = (image.min(axis=1) >= high).tolist()
    words = {"left of": left, "right of": right, "below": below, "above": above}
    return next((word for word, there in words.items() if there), None)


def _edge_on(scene: Scene, camera: Camera) -> bool:
    """Whether all points, of smooth surfaces some all over them, are on one line of the image."""
    shapes = [item.shape for item in scene.items]
    if not all(isinstance(shape, Mesh) or is_parametrised(shape) for shape in shapes):
        return False
    grids = [(shape, np.meshgrid(*shape.domain.grid(8, 8))) for shape in shapes if is_parametrised(shape)]
    smooth = [shape.points(u, v).reshape(-1, 3) for shape, (u, v) in grids]
    points = np.concatenate([scene.vertices, *smooth])
    projection = projection_of(camera, scene.bounds)
    image = projection.image_of(projection.points_of(points[np.isfinite(points).all(axis=1)]))
    image = image - image.mean(axis=1)[:, None]
    far = image[:, np.argmax((image**2).sum(axis=0))]
    return bool(np.abs(far[0] * image[1] - far[1] * image[0]).max() <= ZERO_OF_EXTENT * float((far**2).sum()))


def _spelled(point: Iterable[float]) -> str:
    """A point as options take it."""
    return ",".join(f"{x:.4g}" for x in point)
