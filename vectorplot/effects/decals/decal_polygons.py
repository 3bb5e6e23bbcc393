"""Polygons that lie on faces: shadows, patterns and what else is painted right after the face it lies on."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined, some, with_points
from vectorplot.geometry.records import IN_COLUMNS


@dataclass(frozen=True, eq=False)
class Decals:
    """Polygons on faces of a View, painted right after the face they lie on.

    Parameters
    ----------
    points : (3, c) array of float
        In the view's coordinates, on the planes of their faces.
    offsets : (m+1,) array of int
        Decal k has the points offsets[k] to offsets[k+1], simple, its turn that of the face.
    face : (m,) array of int
        The face of the view it lies on.
    kind : (m,) array of int
        FillKind values.
    grade : (m,) array of int
        How many lights it lacks (0 for decals that are no shadows).
    light : (m,) array of int
        Which light of the scene, -1 for several or none.
    colour : (m,) array of int
        Index into colours, or -1: the face's own.
    level : (m,) array of int
        The order on one face, smaller first, equal ones in any order.
    colours : tuple of str
        Names of palettes and colours.
    lacking : (m,) array of int, optional
        The lights that do not get there at all, bit k for light k; as far as light says where None.
    opacity : (m,) array of float, optional
        How much of the face they cover; all of it where None.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import effects
    >>> from vectorplot.scene import look
    >>> def square(side, height):
    ...     corners = [(-side, -side, height), (side, -side, height), (side, side, height), (-side, side, height)]
    ...     return vp.Mesh.from_polygons(corners, [(0, 1, 2, 3)])
    >>> scene = vp.Scene((vp.Item("floor", square(4, 0)), vp.Item("roof", square(1, 1))))
    >>> shadows = effects.shadow_decals(look(scene, vp.Camera.view("top")), [vp.Light((1, 0, 2), parallel=True)])
    >>> shadows
    <Decals: 1 polygons on 1 faces>
    >>> shadows.light.tolist(), shadows.lights_lacking.tolist()
    ([0], [1])
    """

    points: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints
    face: Ints = field(metadata=EACH_LINE)
    kind: Ints = field(metadata=EACH_LINE)
    grade: Ints = field(metadata=EACH_LINE)
    light: Ints = field(metadata=EACH_LINE)
    colour: Ints = field(metadata=EACH_LINE)
    level: Ints = field(metadata=EACH_LINE)
    colours: tuple[str, ...] = ()
    lacking: Ints | None = field(default=None, metadata=EACH_LINE)
    opacity: Floats | None = field(default=None, metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __repr__(self) -> str:
        return f"<Decals: {len(self)} polygons on {len(np.unique(self.face))} faces>"

    def of(self, decals: Ints) -> Decals:
        """Some of the decals, in the order asked for.

        Parameters
        ----------
        decals : (k,) array of int
            Their numbers.

        Returns
        -------
        Decals
            k polygons.
        """
        return some(self, decals)

    def parts(self, decals: Ints, points: Floats, offsets: Ints) -> Decals:
        """Polygons each of which is a part of one of the decals.

        Parameters
        ----------
        decals : (k,) array of int
            Of which decal each is a part.
        points : (3, c) array of float
            Their corners, in the view's coordinates.
        offsets : (k+1,) array of int
            Polygon i has the points offsets[i] to offsets[i+1].

        Returns
        -------
        Decals
            With all else as of the decals they are parts of.
        """
        # Not through of: each of many parts of a decal would have all its corners first.
        anywhere = np.zeros(points.shape[1], dtype=np.intp)
        return replace(with_points(self, anywhere, decals, offsets), points=points)

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
    return joined(
        [
            replace(d, colour=colour, colours=colours, lacking=d.lights_lacking, opacity=d.opacities)
            for d, colour in zip(decals, renamed, strict=True)
        ]
    )
