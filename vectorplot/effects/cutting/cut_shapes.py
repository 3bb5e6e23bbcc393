"""Smooth surfaces and curves of which parts are cut away."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve, is_curve
from vectorplot.curves.cut_curve import CutCurve, parts_outside
from vectorplot.features.implicit.implicit_sides import BOXED, sides_of
from vectorplot.features.implicit.polygonize import polygonized
from vectorplot.geometry.cuts.half_spaces import HalfSpaces
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.naming.annotations import is_annotation
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_implicit, is_parametrised
from vectorplot.surfaces.trims.boxed_implicit import BoxedImplicit
from vectorplot.surfaces.trims.cut_implicit import CutImplicit
from vectorplot.surfaces.trims.cut_surface import CutSurface
from vectorplot.tolerances.of_numbers import ROUNDING

LOOKS = 64
"""Cells along u and along v at whose corners is looked whether anything of a surface is left."""

NOTHING = Mesh(np.zeros((0, 3)), np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp))
"""What is left of a shape that is cut away as a whole."""


def is_cut(item: Item) -> bool:
    """Whether cuts go through an item: not through axes, dimensions, leaders, centre lines and traces, which are no
    material."""
    return not is_annotation(item) and item.lines != ("trace",)


def smooth_part(
    item: Item, gone: tuple[HalfSpaces, ...], within: HalfSpaces | None = None
) -> Mesh | Surface | ImplicitSurface | Curve:
    """What of the smooth surface or the curve of an item is outside of some regions, and inside of one; a mesh without
    faces where that is nothing."""
    shape = item.shape
    assert not isinstance(shape, Mesh)
    if is_curve(shape):
        parts = parts_outside(shape, gone, within)
        whole = len(parts) == 1 and parts[0].tolist() == [shape.start, shape.end]
        return shape if whole else CutCurve(shape, parts) if len(parts) else NOTHING
    if is_parametrised(shape):
        return _part_of_surface(CutSurface(shape, gone, within))
    assert is_implicit(shape)
    return _part_of_implicit(shape, gone, within)


def _part_of_implicit(
    shape: ImplicitSurface, gone: tuple[HalfSpaces, ...], within: HalfSpaces | None
) -> ImplicitSurface | Mesh:
    """The surface in a smaller box, as far as planes are across x, y or z, and cut by the others; a mesh without faces
    where nothing is left of it."""
    box, oblique, inner = np.array(shape.box, dtype=np.float64), [], within
    for region in (*gone, *([] if within is None else [within])):
        if (side := _across_axis(region)) is None:
            oblique += [region] if region is not within else []
            continue
        inner = None if region is within else inner
        axis, sign, at = side
        is_low = (sign > 0.0) == (region is within)
        row = 0 if is_low else 1
        box[row, axis] = max(box[row, axis], at) if is_low else min(box[row, axis], at)
    if not (box[0] < box[1]).all():
        return NOTHING
    boxed = shape if np.array_equal(box, shape.box) else BoxedImplicit(shape, box)
    if not oblique and inner is None:
        return boxed
    part = CutImplicit(boxed, tuple(oblique), inner)
    whole, left = polygonized(boxed, LOOKS), polygonized(part, LOOKS)
    untouched = left.face_count == whole.face_count and not sides_of(part).on(left.vertices)[:, BOXED:].any()
    return boxed if untouched else part if left.face_count else NOTHING


def _part_of_surface(surface: CutSurface) -> CutSurface | Mesh:
    """The surface; a mesh without faces where nothing is left of it."""
    u, v = np.meshgrid(*surface.domain.grid(LOOKS, LOOKS), indexing="ij")
    with np.errstate(all="ignore"):
        left = np.isfinite(surface.points(u, v)).any()
    return surface if left else NOTHING


def _across_axis(region: HalfSpaces) -> tuple[int, float, float] | None:
    """The axis that the only plane of a region is across, whether the region is above (1) or below (-1) it, and where
    it is; None for other regions."""
    normal: Floats = np.array(region.normals[0])
    axis = int(np.argmax(np.abs(normal)))
    if len(region.normals) > 1 or (np.abs(np.delete(normal, axis)) > ROUNDING).any():
        return None
    sign = float(np.sign(normal[axis]))
    return axis, sign, sign * region.offsets[0]
