"""Shades of the faces of a view, and of their corners: what each light gives, and all of them together.

Everything is in the view's coordinates, which keep angles: lights are brought there first. Points may be barycentres of
faces, corners of smooth surfaces with true normals, or corners of polygons that lie on faces.
Source: Glaeser, sections 4.5 and 8.5.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.columns import cross
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.lines.curve_light import UPPER_LEFT
from vectorplot.scene.view import View
from vectorplot.shading.light.fading import fading_factors, lamp_reach
from vectorplot.shading.light.illumination import (
    backlit,
    brightness,
    depth_cue,
    facing,
    finish_of,
    fitting_factor,
    intensities,
    light_cosines,
    shades,
    towards,
)
from vectorplot.shading.light.palettes import COLOUR_MAP, PALETTE_SIZE, Colours, palette, shaded_colours

HEADLIGHT = Light(UPPER_LEFT, parallel=True, intensity=1.0)
"""The light of a view of a scene without lights, in the view's coordinates; it throws no shadows."""


@dataclass(frozen=True, eq=False)
class Shades:
    """How bright n points are in the light of l lights.

    Parameters
    ----------
    shares : (l, n) array of float
        What a light of intensity 1 gives, 1 and more being as bright as can be.
    matt : (l, n) array of float
        The same without highlights.
    backlit : (l, n) array of bool
        Whether a light shines on their far side.
    intensity : (l,) or (l, 3) array of float
        Of the lights, or of their red, green and blue where one of them is coloured.
    cue : (n,) array of float
        What is added because they are near the eye.

    Notes
    -----
    Source: Glaeser, sections 4.5 and 8.5.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.shading import Shades
    >>> shares = np.array([[0.5, 1.0], [0.25, 0.5]])
    >>> shades = Shades(shares, shares, np.zeros((2, 2), dtype=bool), np.array([1.0, 1.0]), np.zeros(2))
    >>> shades.total.round(6).tolist(), shades.of_light(1).round(6).tolist()
    ([0.6, 0.8], [0.2, 0.4])
    """

    shares: Floats
    matt: Floats
    backlit: Bools
    intensity: Floats
    cue: Floats

    def __len__(self) -> int:
        return len(self.cue)

    @property
    def total(self) -> Floats:
        """(n,) shades from 0 to 1, of all lights together, in coloured light (3,n) of red, green and blue.

        Source: Glaeser, section 4.5, equations 3, 5 and 7."""
        return shades(self.shares, self.intensity, self.cue)

    def of_light(self, number: int) -> Floats:
        """Shades if only one of the lights were on.

        Parameters
        ----------
        number : int
            Of the light, from 0.

        Returns
        -------
        (n,) or (3, n) array of float
            0 to 1; of red, green and blue in coloured light.
        """
        return shades(self.shares[number : number + 1], self.intensity[number : number + 1], self.cue)

    @property
    def fitted(self) -> Shades:
        """The same with intensities such that the brightest point just reaches the end of the lights' part of the
        palette. In a movie keep the intensities of the first picture. Source: Glaeser, section 4.5."""
        return replace(self, intensity=fitting_factor(self.shares, self.intensity) * self.intensity)


def view_lights(view: View, lights: Sequence[Light]) -> tuple[Light, ...]:
    """The lights in the view's coordinates; where there are none, one from the eye's upper left.

    Parameters
    ----------
    view : View
        Whose coordinates they are.
    lights : sequence of Light
        In the world.

    Returns
    -------
    tuple of Light
        At least one; all else of them is as it was.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, shading
    >>> from vectorplot.scene import look
    >>> view = look(vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),)), vp.Camera.view("front"))
    >>> (sun,) = shading.view_lights(view, [vp.Light((0, 0, 1), parallel=True)])
    >>> sun.position
    (0.0, 1.0, 0.0)
    """
    if not lights:
        return (HEADLIGHT,)
    return tuple(replace(light, position=_in_view(view, light)) for light in lights)


def light_colours(lights: Sequence[Light]) -> Floats:
    """(l,3) how much red, green and blue the lights send, their intensities included; (l,) where all are white.

    Errors: InputError for a colour that is none. Source: Glaeser, sections 4.5 and 8.5, note on coloured light sources.
    """
    strength = intensities(lights)
    if all(light.colour == "white" for light in lights):
        return strength
    sent = np.array([palette(light.colour, COLOUR_MAP)[-1] for light in lights]) / 255.0
    return np.asarray(strength[:, None] * sent)


def view_eye(view: View) -> tuple[float, float, float, float]:
    """The eye in homogeneous coordinates of the view."""
    if view.eye is None:
        return (0.0, 0.0, 1.0, 0.0)
    x, y, z = view.eye.tolist()
    return (x, y, z, 1.0)


def face_shades(view: View, items: Sequence[Item], lights: Sequence[Light]) -> Shades:
    """The shades of all faces of a view, at their barycentres, on the sides that the eye sees.

    Parameters
    ----------
    view : View
        With f faces.
    items : sequence of Item
        Of the view's scene.
    lights : sequence of Light
        In the view's coordinates, as of view_lights.

    Returns
    -------
    Shades
        What each light gives to each face, and all of them together.

    Raises
    ------
    InputError
        For an intensity that is negative or not finite, and a position that is not finite.

    Notes
    -----
    Degenerate: faces without area have no normal; to them all lights come in flat.

    Source: Glaeser, section 4.5; errata G4-06 to G4-08.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, shading
    >>> from vectorplot.scene import look
    >>> cube = vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),))
    >>> view = look(cube, vp.Camera((6, 5, 4)))
    >>> lights = shading.view_lights(view, [vp.Light((0, 0, 1), parallel=True)])
    >>> shades = shading.face_shades(view, cube.items, lights)
    >>> shades.total.shape, shades.total.argmax().item()
    ((6,), 5)
    """
    return decal_shades(view, items, lights, face_middles(view), np.arange(view.face_count))


def corner_shades(view: View, items: Sequence[Item], lights: Sequence[Light], normals: Floats) -> Shades:
    """The shades at the corners (c,) of all faces of a view, for smooth shading; arguments as of face_shades.

    normals (3,c): of the surface at every corner, in the view's coordinates, outwards; those of a face that shows its
    inside are turned round with it, so that no corner beside a contour is lit from the wrong side.
    """
    points = view.points[:, view.corners]
    face = ragged.owner(view.face_sizes)
    inside = shows_inside(view)[face]
    return point_shades(view, items, lights, points.T, np.where(inside, -normals, normals).T, view.face_item[face])


def decal_shades(view: View, items: Sequence[Item], lights: Sequence[Light], points: Floats, face: Ints) -> Shades:
    """The shades of points (3,n) that lie on some faces (n,) of a view; arguments as of face_shades."""
    normals = face_normals(view)[:, face]
    outer = facing(normals.T, towards(points.T, view_eye(view)))
    return point_shades(view, items, lights, points.T, outer, view.face_item[face])


def point_shades(
    view: View, items: Sequence[Item], lights: Sequence[Light], points: Floats, normals: Floats, item: Ints
) -> Shades:
    """The shades of points (n,3) with unit normals (n,3), of surfaces of items (n,); the others as of face_shades."""
    eye = view_eye(view)
    own_finish = [finish_of(some.material) for some in items]
    finishes = list(dict.fromkeys(own_finish))
    of_item = np.array([finishes.index(finish) for finish in own_finish], dtype=np.intp)[item]
    shining = any(finish.highlight for finish in finishes)
    alpha, beta = light_cosines(points, normals, eye if shining else None, lights)
    shares, matt = np.zeros((2, *alpha.shape))
    for number, finish in enumerate(finishes):
        own = of_item == number if len(finishes) > 1 else slice(None)
        cosines = alpha[:, own], beta[:, own]
        shares[:, own] = brightness(*cosines, finish)
        matt[:, own] = brightness(*cosines, replace(finish, highlight=0.0)) if finish.highlight else shares[:, own]
    low, high = depth_limits(view)
    found = Shades(shares, matt, backlit(alpha), light_colours(lights), depth_cue(points[:, 2], low, high - low))
    return faded(view, found, lights, points.T) if any(light.fading for light in lights) else found


def faded(view: View, found: Shades, lights: Sequence[Light], points: Floats) -> Shades:
    """The shades of points (3,n), the light of fading lamps weaker with the square of the distance beyond their reach.

    Parallel light does not fade. Source: Glaeser, section 4.5, equation 4, figure 5.
    """
    factors = np.ones_like(found.shares)
    for row, light in zip(factors, lights, strict=True):
        row[:] = fading_factors(light, lamp_reach(view, light), points)
    return replace(found, shares=factors * found.shares, matt=factors * found.matt)


def depth_limits(view: View) -> tuple[float, float]:
    """Smallest and largest z of the scene in the view, no farther than five times the eye's distance from its target,
    and no nearer than a fifth of it. Degenerate: zeros without points.

    Source: Glaeser, section 4.4; erratum G4-04.
    """
    return limited_depths(view, view.points[2])


def limited_depths(view: View, depths: Floats) -> tuple[float, float]:
    """Smallest and largest of depths (n,) z in the view, within the same limits. Degenerate: zeros without any."""
    if not len(depths):
        return 0.0, 0.0
    low, high = float(depths.min()), float(depths.max())
    if view.eye is None:
        return low, high
    target, distance = float(view.target[2]), float(view.eye[2] - view.target[2])
    low = max(low, target - 4.0 * distance)
    return low, max(min(high, target + 0.8 * distance), low)


def face_middles(view: View) -> Floats:
    """The barycentres of the corners of every face.

    Parameters
    ----------
    view : View
        With f faces.

    Returns
    -------
    (3, f) array of float
        In the view's coordinates.

    Notes
    -----
    Degenerate: no columns for a view without faces.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, shading
    >>> from vectorplot.scene import look
    >>> view = look(vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),)), vp.Camera.view("top"))
    >>> shading.face_middles(view).T[-1].tolist()
    [0.0, 0.0, 1.0]
    """
    if not view.face_count:
        return np.zeros((3, 0))
    if view.is_triangular:
        a, b, c = (view.points[:, view.corners[k::3]] for k in range(3))
        return np.asarray((a + b + c) / 3.0)
    sums = np.add.reduceat(view.points[:, view.corners], view.offsets[:-1], axis=1)
    return np.asarray(sums / view.face_sizes)


def face_normals(view: View) -> Floats:
    """(3,f) unit outer normals of every face; zeros for one without area."""
    if not view.face_count:
        return np.zeros((3, 0))
    points = view.points
    if view.is_triangular:
        a, b, c = (points[:, view.corners[k::3]] for k in range(3))
        normals = cross(b - a, c - a)
    else:
        first = np.repeat(view.corners[view.offsets[:-1]], view.face_sizes)
        arm = points[:, view.corners] - points[:, first]
        after = arm[:, view.after(np.arange(len(view.corners)))]
        normals = np.add.reduceat(cross(arm, after), view.offsets[:-1], axis=1)
    length = np.sqrt(np.einsum("ij,ij->j", normals, normals))
    return np.asarray(normals / np.where(length > 0.0, length, 1.0))


def shows_inside(view: View) -> Bools:
    """(f,) whether the eye sees the inner side of a face."""
    to_eye = towards(view.points[:, view.corners[view.offsets[:-1]]].T, view_eye(view))
    return np.asarray(np.einsum("ij,ji->j", face_normals(view), to_eye) < 0.0)


def face_colours(view: View, items: Sequence[Item], shade: Floats, count: int = PALETTE_SIZE) -> Colours:
    """The colours of all faces of a view at some shades.

    Parameters
    ----------
    view : View
        With f faces.
    items : sequence of Item
        Of the view's scene, with their palettes.
    shade : (f,) or (3, f) array of float
        0 to 1; of red, green and blue in coloured light.
    count : int
        How many shades a palette has.

    Returns
    -------
    (f, 3) array of uint8
        Red, green and blue.

    Raises
    ------
    InputError
        For an unknown palette, or a wrong count.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, shading
    >>> from vectorplot.scene import look
    >>> cube = vp.Scene((vp.Item("cube", geometry.box((2, 2, 2)), "gray"),))
    >>> view = look(cube, vp.Camera((6, 5, 4)))
    >>> shading.face_colours(view, cube.items, np.array([0, 0, 0, 0, 0, 1.0]))[4:].tolist()
    [[0, 0, 0], [255, 255, 255]]
    """
    return item_colours(items, view.face_item, shade, count)


def item_colours(items: Sequence[Item], item: Ints, shade: Floats, count: int = PALETTE_SIZE) -> Colours:
    """(n,3) the colours of items (n,) at shades (n,) or (3,n) from 0 to 1, of palettes of so many shades.

    Errors: InputError that names the colour, where there is none of that name.
    """
    names = list(dict.fromkeys(some.colour for some in items))
    which = np.array([names.index(some.colour) for some in items], dtype=np.intp)
    return shaded_colours(names, which[item], shade, count)


def _in_view(view: View, light: Light) -> tuple[float, float, float]:
    """Where a light is in the view, or the direction it comes from there."""
    given = np.array(light.position, dtype=np.float64)
    x, y, z = (matmul(view.axes, given) if light.parallel else view.points_of(given[None])[:, 0]).tolist()
    return (x, y, z)
