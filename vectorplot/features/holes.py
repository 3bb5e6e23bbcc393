"""Parameters moved into the domain of a surface, and the holes of surfaces: where they begin, and ways around them."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.geometry.chord_refinement import narrowed
from vectorplot.geometry.elementary import log
from vectorplot.geometry.vectors import all_finite, from_components
from vectorplot.surfaces.stacked import of_some
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.tolerances import AROUND_RIM, OUTSIDE_DOMAIN, RIM_FOUND_TO, RIM_SEEN_FROM

# Parameters moved into the domain of a surface.


def wrapped(domain: Domain, u: Floats, v: Floats) -> tuple[Floats, Floats]:
    """The parameters moved by whole periods into the domain, in its closed directions."""
    width, height = domain.size
    if domain.closed_u:
        u = u - np.floor((u - domain.u_start) / width) * width
    if domain.closed_v:
        v = v - np.floor((v - domain.v_start) / height) * height
    return u, v


def clipped(domain: Domain, places: Floats) -> Floats:
    """(...,d) places (...,d), those beyond an open border on it."""
    result = places.copy()
    for axis, closed, low, high in (
        (0, domain.closed_u, domain.u_start, domain.u_end),
        (1, domain.closed_v, domain.v_start, domain.v_end),
    ):
        if not closed:
            result[..., axis] = np.clip(places[..., axis], low, high)
    return result


def inside(domain: Domain, places: Floats) -> tuple[Floats, Floats]:
    """(k,) u and v of places within the domain: a place beyond an open border is the border's."""
    within = clipped(domain, places)
    return wrapped(domain, within[..., 0], within[..., 1])


def ways_between(domain: Domain, start: Floats, end: Floats) -> Floats:
    """(...,2) the ways from places (...,2) of a domain to others, the shorter ones round where it is closed."""
    way = end - start
    for axis, (closed, size) in enumerate(zip((domain.closed_u, domain.closed_v), domain.size, strict=True)):
        if closed:
            way[..., axis] -= size * np.round(way[..., axis] / size)
    return way


def near_to(domain: Domain, places: Floats, others: Floats) -> Floats:
    """(k,2) the places (k,2), in closed directions whole periods away, that are nearest to others (k,2)."""
    result = places.copy()
    for axis, (closed, size) in enumerate(zip((domain.closed_u, domain.closed_v), domain.size, strict=True)):
        if closed:
            result[:, axis] += size * np.round((others[:, axis] - places[:, axis]) / size)
    return result


# Holes of surfaces: where in their domains they have no points, and where those areas begin.

AT_ONCE = 1 << 10
"""Places that are looked at in one step to a rim, at least one each: few of them take as long as one."""

MOST_PARTS = 32
"""A way is divided into no more parts in one step."""

ASIDE = (1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0, 1.0 / 2.0, 3.0 / 4.0)
"""How far beside a chord its rim is looked for, in lengths of the chord: at the corner of a square hole it is half of
one away."""

AROUND = 16
"""Ways from a place on a rim that are tried to find to which side the surface lies."""

STEPS = 16
"""Parts of a way that is looked along for a hole."""


def is_known(surface: Surface, places: Floats) -> Bools:
    """(...,k) whether places (...,k,2) are in the domain of a surface and in none of its holes; of stacked surfaces,
    each of the k on its own one."""
    u, v = wrapped(surface.domain, places[..., 0], places[..., 1])
    with np.errstate(all="ignore"):
        known = all_finite(surface.points(u, v))
    return known & in_domain(surface.domain, places)


def in_domain(domain: Domain, places: Floats) -> Bools:
    """(...,k) whether places (...,k,2) are in a domain, or in one of its further rounds."""
    closed, starts = (domain.closed_u, domain.closed_v), (domain.u_start, domain.v_start)
    found = np.ones(places.shape[:-1], dtype=np.bool_)
    for axis, (round_, start, size) in enumerate(zip(closed, starts, domain.size, strict=True)):
        part = (places[..., axis] - start) / size
        found &= round_ | ((part >= -OUTSIDE_DOMAIN) & (part <= 1.0 + OUTSIDE_DOMAIN))
    return found


def last_alike(surface: Surface, base: Floats, ways: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Parts of ways (k,2) from places base (k,2) between parts low and high (k,), the places at which are in a hole at
    one of both: the last parts that are as at low, and the first ones that are not, no farther apart in the domain than
    RIM_FOUND_TO."""
    size = from_components(*surface.domain.size)
    with np.errstate(all="ignore"):
        long = np.nan_to_num(float(np.max(np.abs((high - low)[:, None] * ways / size), initial=0.0)), nan=0.0)
    number = int(np.clip(AT_ONCE // max(len(base), 1), 2, MOST_PARTS))
    steps = int(np.ceil(log(max(long / RIM_FOUND_TO, 1.0)) / log(number)))
    there = is_known(surface, base + low[:, None] * ways)
    return narrowed(lambda tried: is_known(surface, base + tried[..., None] * ways) == there, low, high, number, steps)


def beside_rim_chords(surface: Surface, start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
    """The places (k,2) of rims at parts (k,) of chords from places to places (k,2) on them, straight across the chord,
    the nearest ones; and which were found. Others are on the chord, or at the end of it that is nearer.
    """
    size = from_components(*surface.domain.size)
    way = (end - start) / size
    base = start + part[:, None] * (end - start)
    # From the surface to the hole, or from the hole to the surface.
    there = is_known(surface, base)
    across = np.stack([way[:, 1], -way[:, 0]], axis=1) * size
    aside = np.stack([ASIDE, np.negative(ASIDE)], axis=1).ravel()
    tried = base + aside[:, None, None] * across
    changed = is_known(surface, tried) != there
    found: Bools = np.asarray(changed.any(axis=0))
    first = np.argmax(changed, axis=0)
    low, high = np.concatenate([[0.0, 0.0], aside])[first], aside[first]
    row = np.flatnonzero(found)
    low, high = low[row], high[row]
    own = of_some(surface, row)
    low, high = last_alike(own, base[row], across[row], low, high)
    result = np.where(there[:, None], base, np.where((part < 0.5)[:, None], start, end))
    inwards = np.where(there[row], -np.sign(high), np.sign(high))[:, None] * across[row]
    result[row] = just_inside(own, base[row] + np.where(there[row], low, high)[:, None] * across[row], inwards)
    return result, found


def just_inside(surface: Surface, places: Floats, inwards: Floats) -> Floats:
    """The places (k,2) on rims, moved along ways (k,2) into the surface by RIM_SEEN_FROM."""
    size = from_components(*surface.domain.size)
    long = np.linalg.norm(inwards / size, axis=1, keepdims=True)
    inner = places + np.divide(RIM_SEEN_FROM * inwards, long, out=np.zeros_like(inwards), where=long > 0.0)
    return np.where(is_known(surface, inner)[:, None], inner, places)


def up_to_rims(surface: Surface, start: Floats, ways: Floats) -> tuple[Floats, Bools]:
    """(k,2) the places at which ways (k,2) from places start (k,2) first come to a hole; and which of them do."""
    parts = np.arange(1, STEPS + 1) / STEPS
    tried = start + parts[:, None, None] * ways
    gone = ~is_known(surface, tried)
    found: Bools = np.asarray(gone.any(axis=0))
    high = parts[np.argmax(gone, axis=0)]
    low = high - 1.0 / STEPS
    low, _ = last_alike(surface, start, ways, low, high)
    return just_inside(surface, start + low[:, None] * ways, -ways), found


def into_surface(surface: Surface, places: Floats) -> Floats:
    """(k,2) short ways in the domain from places (k,2) on rims into the surface; 0 for places around which there is no
    hole."""
    tried = around(surface, places)
    known = is_known(surface, tried)
    way = (known[..., None] * (tried - places)).mean(axis=0)
    return np.where(np.asarray(known.all(axis=0))[:, None], 0.0, way)


def along_rims(surface: Surface, places: Floats, inwards: Floats) -> tuple[Floats, Floats]:
    """The places (k,2) of rims to the right and to the left of places (k,2) on them; inwards (k,2): the short ways into
    the surface, as long as the steps to the sides. At corners and ends of rims a place may stay where it is."""
    twice = np.tile(np.arange(len(places)), 2)
    own, at, way = of_some(surface, twice), places[twice], inwards[twice]
    size = from_components(*own.domain.size)
    aside = from_components(-way[:, 1], way[:, 0]) * size / size[..., ::-1]
    base = at + np.where(np.arange(len(at)) < len(places), -1.0, 1.0)[:, None] * aside
    there = is_known(own, base + way) & ~is_known(own, base - way)
    one = np.ones(len(at))
    low, _ = last_alike(own, base, way, one, -one)
    found = np.where(there[:, None], just_inside(own, base + low[:, None] * way, way), at)
    return found[: len(places)], found[len(places) :]


def around(surface: Surface, places: Floats) -> Floats:
    """(a,k,2) places around places (k,2), AROUND_RIM of the domain from them."""
    angle = 2.0 * np.pi * (np.arange(AROUND) + 0.5) / AROUND
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    size = np.broadcast_to(from_components(*surface.domain.size), places.shape)
    return np.asarray(places + AROUND_RIM * ring[:, None] * size)
