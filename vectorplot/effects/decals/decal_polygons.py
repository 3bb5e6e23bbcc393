"""Polygons that lie on faces: shadows, patterns and what else is painted right after the face it lies on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged


@dataclass(frozen=True, eq=False)
class Decals:
    """Polygons on faces of a View, painted right after the face they lie on.

    points (3,c) in the view's coordinates, on the planes of their faces; offsets (m+1,): decal k has the points
    offsets[k] to offsets[k+1], simple, its turn that of the face; face (m,) the face of the view it lies on; kind (m,)
    of FillKind; grade (m,) how many lights it lacks (0 for decals that are no shadows); light (m,) which light of the
    scene, -1 for several or none; colour (m,) index into colours, or -1: the face's own; level (m,) the order on one
    face, smaller first, equal ones in any order; colours: names of palettes and colours; lacking (m,): the lights that
    do not get there at all, bit k for light k (None: as far as light says); opacity (m,) how much of the face they
    cover (None: all of it).
    """

    points: Floats
    offsets: Ints
    face: Ints
    kind: Ints
    grade: Ints
    light: Ints
    colour: Ints
    level: Ints
    colours: tuple[str, ...] = ()
    lacking: Ints | None = None
    opacity: Floats | None = None

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __repr__(self) -> str:
        return f"<Decals: {len(self)} polygons on {len(np.unique(self.face))} faces>"

    def of(self, decals: Ints) -> Decals:
        """Some of the decals, given by their numbers, in that order."""
        sizes = np.diff(self.offsets)[decals]
        offsets = ragged.offsets(sizes)
        corners = ragged.ranges(self.offsets[:-1][decals], sizes)
        return Decals(
            self.points[:, corners],
            offsets,
            self.face[decals],
            self.kind[decals],
            self.grade[decals],
            self.light[decals],
            self.colour[decals],
            self.level[decals],
            self.colours,
            None if self.lacking is None else self.lacking[decals],
            None if self.opacity is None else self.opacity[decals],
        )

    @property
    def lights_lacking(self) -> Ints:
        """(m,) the lights that do not get there, bit k for light k."""
        if self.lacking is not None:
            return self.lacking
        return np.where(self.light >= 0, np.left_shift(1, np.maximum(self.light, 0)), 0)

    @property
    def opacities(self) -> Floats:
        """(m,) how much of the face each covers, 0 to 1."""
        return np.ones(len(self)) if self.opacity is None else self.opacity

    @property
    def painting_order(self) -> Ints:
        """(m,) the decals by faces, and on each face by level, otherwise as they are."""
        return np.lexsort((self.level, self.face))


def no_decals() -> Decals:
    """No decals at all."""
    none = np.zeros(0, dtype=np.intp)
    return Decals(np.zeros((3, 0)), np.zeros(1, dtype=np.intp), none, none, none, none, none, none)


def joined_decals(*decals: Decals) -> Decals:
    """All decals one after the other; colours of the same name become one."""
    if not decals:
        return no_decals()
    colours = tuple(dict.fromkeys(name for d in decals for name in d.colours))
    number = {name: k for k, name in enumerate(colours)}
    renamed = [np.array([*(number[name] for name in d.colours), -1], dtype=np.intp)[d.colour] for d in decals]
    counts = [d.offsets[-1] for d in decals]
    starts = ragged.starts(counts)
    offsets = [np.zeros(1, dtype=np.intp), *(d.offsets[1:] + s for d, s in zip(decals, starts, strict=True))]
    return Decals(
        np.concatenate([d.points for d in decals], axis=1),
        np.concatenate(offsets),
        np.concatenate([d.face for d in decals]),
        np.concatenate([d.kind for d in decals]),
        np.concatenate([d.grade for d in decals]),
        np.concatenate([d.light for d in decals]),
        np.concatenate(renamed),
        np.concatenate([d.level for d in decals]),
        colours,
        np.concatenate([d.lights_lacking for d in decals]),
        np.concatenate([d.opacities for d in decals]),
    )
