"""Unit normals, at poles and singular points too."""

from __future__ import annotations

import numpy as np

from vectorplot.geometry.mesh import Bools, Floats
from vectorplot.surfaces.surface import Domain, Surface

# A cross product below this part of what the second derivatives allow is that of a pole.
_POLE = 1e-9


def unit_normals(surface: Surface, u: Floats, v: Floats) -> Floats:
    """(..., 3) unit vectors along x_u cross x_v.

    Where the cross product vanishes the normal is the limit from the side of the middle of the domain: along the line
    v = const. at a pole where u does not move the point (top of a sphere), along u = const. where v does not; so that
    normals near the pole run into it without a spike. An apex has one limit for each line that ends there. Where a
    surface passes through its axis (spindle torus) the normals of the two sides are opposite, and that side decides.
    Degenerate: NaN in holes, and where the first derivative of the cross product vanishes too.
    Error: at a pole as good as the second partials.
    """
    u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
    along_u, along_v = surface.partials(u, v)
    product = np.asarray(np.cross(along_u, along_v), dtype=np.float64)
    suspect = _small(product, along_u, along_v, surface.domain)
    if suspect.any():
        product[suspect] = _with_limits(surface, u[suspect], v[suspect], product[suspect])
    # Divided by the largest component first: a product of tiny partials has a square that underflows.
    with np.errstate(divide="ignore", invalid="ignore"):
        product /= np.abs(product).max(axis=-1, keepdims=True, initial=0.0)
        return np.asarray(product / np.linalg.norm(product, axis=-1, keepdims=True))


def _small(product: Floats, along_u: Floats, along_v: Floats, domain: Domain) -> Bools:
    """(...,) where the product is small beside the squared size of the surface, as far as partials tell it."""
    width, height = domain.size
    size = np.linalg.norm(along_u, axis=-1) * width + np.linalg.norm(along_v, axis=-1) * height
    return np.asarray(np.linalg.norm(product, axis=-1) * width * height <= 1e-6 * size * size)


def _with_limits(surface: Surface, u: Floats, v: Floats, product: Floats) -> Floats:
    """(n, 3) the product where it is one, else its derivative towards the middle of the domain."""
    along_u, along_v = surface.partials(u, v)
    uu, uv, vv = surface.second_partials(u, v)
    domain = surface.domain
    width, height = domain.size
    a = _inwards(u, domain.u_start, domain.u_end)
    b = _inwards(v, domain.v_start, domain.v_end)
    towards_u, towards_v = a * width * uu + b * height * uv, a * width * uv + b * height * vv
    limit = np.cross(towards_u, along_v) + np.cross(along_u, towards_v)
    bound = (_length(along_u) + _length(uu) * width + _length(uv) * height) * (
        _length(along_v) + _length(uv) * width + _length(vv) * height
    )
    vanished = _length(product) <= _POLE * bound
    gone = vanished & (_length(limit) <= _POLE * bound)
    return np.where(gone[:, None], np.nan, np.where(vanished[:, None], limit, product))


def _inwards(t: Floats, start: float, end: float) -> Floats:
    """(n, 1) the sign of the way to the middle. The way along the line of a pole itself does not count: it stands."""
    return np.where(t <= 0.5 * (start + end), 1.0, -1.0)[:, None]


def _length(vectors: Floats) -> Floats:
    return np.asarray(np.linalg.norm(vectors, axis=-1))
