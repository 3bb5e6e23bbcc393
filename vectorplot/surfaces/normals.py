"""Unit normals and how they turn, at poles and singular points too."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.geometry.components import component_sum
from vectorplot.geometry.vectors import cross, largest_component, norm
from vectorplot.surfaces.jets import FirstJets, first_jets, second_jets
from vectorplot.surfaces.stacked import of_some
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.tolerances.of_parameters import ASIDE_OF_POLE
from vectorplot.tolerances.of_values import SINGULAR_PRODUCT, SUSPECT_PRODUCT

Partials = tuple[Floats, Floats]
SecondPartials = tuple[Floats, Floats, Floats]


def unit_normals(surface: Surface, u: Floats, v: Floats) -> Floats:
    """The unit normals of a surface, along x_u cross x_v; at poles their limits.

    Parameters
    ----------
    surface : Surface
        With its partials and second partials.
    u, v : (...) array_like of float
        Parameters; they are broadcast.

    Returns
    -------
    (..., 3) array of float
        Vectors of length 1.

    Notes
    -----
    Where the cross product vanishes the normal is the limit from the side of the middle of the domain: along the line v
    = const. at a pole where u does not move the point (top of a sphere), along u = const. where v does not; so that
    normals near the pole run into it without a spike. An apex has one limit for each line that ends there. Where a
    surface passes through its axis (spindle torus) the normals of the two sides are opposite, and that side decides. At
    a pole the normals are as good as the second partials.

    Degenerate: NaN in holes, and where the first derivative of the cross product vanishes too.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> north = surfaces.unit_normals(surfaces.Sphere(2.0), 0.3, np.pi / 2)
    >>> bool(np.allclose(north, (0.0, 0.0, 1.0)))
    True
    """
    u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
    return unit_normals_of(surface, u, v, surface.partials(u, v))


def tangent_planes(surface: Surface, u: Floats, v: Floats) -> tuple[FirstJets, Floats]:
    """Points and derivatives by u and by v, and unit normals as of `unit_normals`, each (..., 3), at parameters u, v
    (...)."""
    points, along_u, along_v = first_jets(surface, u, v)
    return (points, along_u, along_v), unit_normals_of(surface, u, v, (along_u, along_v))


def points_and_normals(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, Floats]:
    """Points, and unit normals as of `unit_normals`, each (..., 3)."""
    u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
    (points, _, _), normals = tangent_planes(surface, u, v)
    return points, normals


def unit_normals_of(surface: Surface, u: Floats, v: Floats, partials: Partials) -> Floats:
    """(..., 3) the unit normals at parameters u, v (...), where the surface has these partials."""
    product = cross(*partials)
    suspect = _small(product, *partials, surface.domain)
    if suspect.any():
        known = (partials[0][suspect], partials[1][suspect])
        product[suspect] = _with_limits(of_some(surface, suspect), u[suspect], v[suspect], known, product[suspect])
    # Divided by the largest component first: a product of tiny partials has a square that underflows.
    with np.errstate(divide="ignore", invalid="ignore"):
        product /= largest_component(product)[..., None]
        return np.asarray(product / norm(product)[..., None])


def normal_partials(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
    """Unit normals and their derivatives by u and by v, each (..., 3): N = n / |n|, N_u = (n_u - (n_u.N) N) / |n|.

    n = x_u cross x_v, n_u = x_uu cross x_v + x_u cross x_uv. At a pole the derivatives are those a millionth of the
    domain inside.
    Degenerate: NaN in holes, and where the normals are NaN. Error: as good as the second partials.
    """
    u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
    return _normal_partials(surface, u, v, surface.partials(u, v), surface.second_partials(u, v))


def points_and_normal_partials(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, tuple[Floats, Floats, Floats]]:
    """Points (..., 3), and what `normal_partials` says there."""
    u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
    points, along_u, along_v, *second = second_jets(surface, u, v)
    uu, uv, vv = second
    return points, _normal_partials(surface, u, v, (along_u, along_v), (uu, uv, vv))


def _normal_partials(
    surface: Surface, u: Floats, v: Floats, partials: Partials, second: SecondPartials
) -> tuple[Floats, Floats, Floats]:
    """As `normal_partials`, where the surface has these partials and second partials."""
    unit = unit_normals_of(surface, u, v, partials)
    by_u, by_v, vanished = _turning(surface.domain, partials, second, unit)
    if vanished.any():
        own = of_some(surface, vanished)
        domain, u, v = own.domain, u[vanished], v[vanished]
        inner_u = u + _inwards(u, domain.u_start, domain.u_end) * ASIDE_OF_POLE * domain.size[0]
        inner_v = v + _inwards(v, domain.v_start, domain.v_end) * ASIDE_OF_POLE * domain.size[1]
        inner = own.partials(inner_u, inner_v)
        inside = unit_normals_of(own, inner_u, inner_v, inner)
        bent = own.second_partials(inner_u, inner_v)
        by_u[vanished], by_v[vanished], _ = _turning(own.domain, inner, bent, inside)
    return unit, by_u, by_v


def _turning(domain: Domain, partials: Partials, second: SecondPartials, unit: Floats) -> tuple[Floats, Floats, Bools]:
    """Derivatives (..., 3) of the unit normals by u and by v, and (...,) where they are lost at a pole."""
    along_u, along_v = partials
    uu, uv, vv = second
    product = cross(along_u, along_v)
    vanished = norm(product) <= SINGULAR_PRODUCT * _bound(domain, partials, second)
    size = largest_component(product)[..., None]
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / (norm(product / size)[..., None] * size)
        turned = [
            np.asarray((d - component_sum(d * unit)[..., None] * unit) * inverse)
            for d in (cross(uu, along_v) + cross(along_u, uv), cross(uv, along_v) + cross(along_u, vv))
        ]
    return turned[0], turned[1], np.asarray(vanished, dtype=np.bool_)


def _small(product: Floats, along_u: Floats, along_v: Floats, domain: Domain) -> Bools:
    """(...,) where the product is small beside the squared size of the surface, as far as partials tell it."""
    width, height = domain.size
    size = norm(along_u) * width + norm(along_v) * height
    return np.asarray(norm(product) * width * height <= SUSPECT_PRODUCT * size * size)


def _with_limits(surface: Surface, u: Floats, v: Floats, partials: tuple[Floats, Floats], product: Floats) -> Floats:
    """(n, 3) the product of the partials where it is one, else its derivative towards the middle of the domain."""
    along_u, along_v = partials
    uu, uv, vv = surface.second_partials(u, v)
    domain = surface.domain
    width, height = domain.size
    a = (_inwards(u, domain.u_start, domain.u_end) * width)[:, None]
    b = (_inwards(v, domain.v_start, domain.v_end) * height)[:, None]
    towards_u, towards_v = a * uu + b * uv, a * uv + b * vv
    limit = cross(towards_u, along_v) + cross(along_u, towards_v)
    bound = _bound(domain, partials, (uu, uv, vv))
    vanished = norm(product) <= SINGULAR_PRODUCT * bound
    gone = vanished & (norm(limit) <= SINGULAR_PRODUCT * bound)
    return np.where(gone[:, None], np.nan, np.where(vanished[:, None], limit, product))


def _bound(domain: Domain, first: Partials, second: SecondPartials) -> Floats:
    """(...,) how large the cross product can be on a domain with these partials."""
    (width, height), (uu, uv, vv) = domain.size, second
    return np.asarray(
        (norm(first[0]) + norm(uu) * width + norm(uv) * height)
        * (norm(first[1]) + norm(uv) * width + norm(vv) * height)
    )


def _inwards(t: Floats, start: float, end: float) -> Floats:
    """(n,) the sign of the way to the middle. The way along the line of a pole itself does not count: it stands."""
    return np.where(t <= 0.5 * (start + end), 1.0, -1.0)
