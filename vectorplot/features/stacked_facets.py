"""Facets of many surfaces: those of one family are divided as one, which takes few more calls than one of them."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol, Self, runtime_checkable

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.edge_splitting import Demand, Net, Vertices, refined, surface_numbers
from vectorplot.features.facets import Facets, facets, finished
from vectorplot.features.parametric.poles import poles
from vectorplot.features.patch_nets import Patch, first_counts, grid_net
from vectorplot.geometry import ragged
from vectorplot.surfaces.parts import creases
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.stacked import ExactRows, StackedSurfaces, dimensions_of
from vectorplot.surfaces.surface import Surface, is_parametrised

LOT = 16
"""So many surfaces are divided at once at most: with more of them caches no longer hold their arrays."""

MANY = 1000
"""Triangles of the first nets in the mean from which on surfaces are divided one after the other: each has enough to
do by itself."""


@runtime_checkable
class Joinable(Demand, Protocol):
    """A demand that can be made of several surfaces at once."""

    @property
    def alike(self) -> Hashable:
        """Equal for demands that can be joined."""
        ...

    @classmethod
    def joined(cls, asked: Sequence[Self]) -> Demand:
        """That of several surfaces, told apart by the numbers of those that places are on."""
        ...


@dataclass(frozen=True, eq=False)
class Patches(Patch):
    """Surfaces of one family over one domain with the same poles and without sharp edges, the first one for all in what
    they have in common; the fourth number of a place tells which one it is on."""

    stack: StackedSurfaces

    def surface_at(self, places: Floats) -> Surface:
        """The surface of each place."""
        return ExactRows(self.stack, surface_numbers(places))

    def on(self, places: Floats, numbers: Ints) -> Floats:
        """(s*n,4) places (n,3) on each of some surfaces (s,), by their numbers."""
        return np.column_stack([np.tile(places, (len(numbers), 1)), np.repeat(numbers, len(places))])


def facets_of_all(shapes: Sequence[Any], demand: Callable[[int], Demand], most: int) -> list[Facets]:
    """The facets of each of some surfaces, to the last bit those that it has alone.

    demand: how fine those of a shape have to be, by its number; most: triangles of each. What is no surface of a
    family, such as a user's own function, is divided alone.
    Errors: as of facets.
    """
    made: dict[int, Facets] = {}
    families: dict[Hashable, list[int]] = {}
    for number, shape in enumerate(shapes):
        families.setdefault(_family(shape) or number, []).append(number)
    for family in families.values():
        for start in range(0, len(family), LOT):
            lot = family[start : start + LOT]
            asked = [demand(number) for number in lot]
            for own in _joinable(asked):
                numbers = [lot[k] for k in own]
                found = _together([shapes[k] for k in numbers], [asked[k] for k in own], most)
                made.update(zip(numbers, found, strict=True))
    return [made[number] for number in range(len(shapes))]


def _family(shape: Any) -> Hashable:
    """Equal for surfaces that can be divided as one, None for others."""
    inner = shape.surface if isinstance(shape, PlacedSurface) else shape
    names = dimensions_of(inner)
    if not names or not is_parametrised(inner) or len(creases(shape)):
        return None
    known = tuple(getattr(inner, name) is None for name in names)
    return type(inner), known, inner.domain, tuple((pole.axis, pole.place) for pole in poles(shape))


def _joinable(asked: Sequence[Demand]) -> list[list[int]]:
    """The numbers of demands, those together that can be joined."""
    found: dict[Hashable, list[int]] = {}
    for number, one in enumerate(asked):
        key = (type(one), one.alike) if isinstance(one, Joinable) else number
        found.setdefault(key, []).append(number)
    return list(found.values())


def _together(shapes: Sequence[Any], asked: Sequence[Any], most: int) -> list[Facets]:
    """The facets of shapes of one family."""
    if len(shapes) == 1:
        return [facets(shapes[0], asked[0], most)]
    demand = type(asked[0]).joined(asked)
    single = [Patch(shape, tuple(poles(shape))) for shape in shapes]
    patches = Patches(shapes[0], single[0].poles, StackedSurfaces.of(shapes))
    counts = first_counts(patches, len(shapes), demand)
    first = [grid_net(shape, *count) for shape, count in zip(shapes, counts, strict=True)]
    if sum(len(net.triangles) for net in first) > MANY * len(shapes):
        nets = [refined(*each, most) for each in zip(first, single, asked, strict=True)]
        return [finished(patch, net) for patch, net in zip(single, nets, strict=True)]
    nets = _apart(refined(_as_one(first), patches, demand, most), len(shapes))
    return [finished(patch, net) for patch, net in zip(single, nets, strict=True)]


def _as_one(nets: Sequence[Net]) -> Net:
    """The nets of several surfaces, the vertices and triangles of one after those of the other."""
    shift = ragged.offsets([len(net.vertices.points) for net in nets])
    vertices = [
        replace(net.vertices, places=np.column_stack([net.vertices.places, np.full(len(net.vertices.points), number)]))
        for number, net in enumerate(nets)
    ]
    parts = zip(*((v.places, v.points, v.normals) for v in vertices), strict=True)
    joined = Vertices(*(np.concatenate(some) for some in parts))
    return Net(joined, np.concatenate([net.triangles + start for net, start in zip(nets, shift[:-1], strict=True)]))


def _apart(net: Net, count: int) -> list[Net]:
    """The nets of each of so many surfaces."""
    of = surface_numbers(net.vertices.places)
    of_triangle = of[net.triangles[:, 0]]
    place = np.empty(len(of), dtype=np.intp)
    found = []
    for number in range(count):
        own = np.flatnonzero(of == number)
        place[own] = np.arange(len(own))
        vertices = net.vertices.some(own)
        vertices = replace(vertices, places=np.ascontiguousarray(vertices.places[:, :3]))
        stopped = (0,) if number in net.stopped else ()
        found.append(Net(vertices, place[net.triangles[of_triangle == number]], stopped))
    return found
