"""How bright points of surfaces are and how lines and lights fade: Lambert's law, highlights, distance and depth.

Source: Glaeser, sections 4.5 and 8.5.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import linear_solution, matmul
from vectorplot.geometry.elementary import arccos, power
from vectorplot.geometry.vectors import component_sum, norm
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.view import View
from vectorplot.tolerances import LEAST_DIVISOR

# How bright points of surfaces are: Lambert's law, dark sides, highlights, distance and depth.
#
# Shades are parts of a palette, from 0 to 1. Light sources share four fifths of it; the last fifth is ambient light,
# and goes to what is near the eye. Points may be barycentres of faces, vertices, or what is visible in each pixel.

AMBIENT = 0.2
"""The part of the palette that is kept for ambient light (decision D-5)."""

DIRECT_SHARE = 1.0 - AMBIENT
"""The part that light sources fill."""

DARK_SIDE = 0.3
"""How bright a face is that is lit from behind, against one lit from the front at the same angle (decision D-5)."""


SHADOW_SHARE = 0.5
"""The part of a light's shade that is left where the light does not get: half of the reduced palette for one light
(decision D-5)."""


@dataclass(frozen=True)
class Finish:
    """What a material makes of light: diffuse * cos^exponent(alpha) + highlight * weight(alpha) * cos^sharpness(beta);
    alpha between normal and light, beta between reflected ray and eye. exponent, sharpness: positive; diffuse: not
    negative; highlight: 0 for none; weight: a constant, or measured pairs of an angle in radians and a value, joined
    by a cubic spline.
    Source: Glaeser, sections 4.5 (equation 2), 8.5 (equations 31 and 32).
    """

    exponent: float = 1.0
    diffuse: float = 1.0
    highlight: float = 0.0
    sharpness: float = 1.0
    weight: float | tuple[tuple[float, float], ...] = 0.1

    def __post_init__(self) -> None:
        factors = (self.exponent, self.diffuse, self.highlight, self.sharpness)
        if not all(0.0 <= f < np.inf for f in factors) or not min(self.exponent, self.sharpness) > 0.0:
            raise InputError(f"material: {factors} are not all positive, finite numbers")
        table = np.asarray(self.weight, dtype=np.float64)
        if not np.isfinite(table).all() or (table.ndim and (table.ndim != 2 or table.shape[1] != 2 or len(table) < 2)):
            raise InputError("material: the weight of the highlight is one number, or two or more pairs of numbers")
        if table.ndim and not (np.diff(table[:, 0]) > 0.0).all():
            raise InputError("material: the angles of the measured highlight must rise")

    @classmethod
    def polished(cls, sharpness: float, diffuse: float = 0.4, exponent: float = 1.0) -> Finish:
        """A reflecting material.

        Source: Glaeser, section 8.5, equation 32.
        """
        if not sharpness > 1.0:
            raise InputError(f"material: a sharpness of {sharpness:g} is no highlight")
        return cls(exponent, diffuse, float(np.log2(sharpness)), sharpness)

    def weight_at(self, cosine: Floats) -> Floats:
        """The weight of the highlight where the light comes in at some angle.

        cosine: (...) of the angle between normal and light; result: (...) never negative.
        """
        if isinstance(self.weight, float | int):
            return np.full(cosine.shape, max(float(self.weight), 0.0))
        from scipy.interpolate import CubicHermiteSpline

        angles, values = np.array(self.weight).T
        angle = np.clip(arccos(np.clip(cosine, -1.0, 1.0)), angles[0], angles[-1])
        return np.asarray(np.maximum(CubicHermiteSpline(angles, values, _natural_slopes(angles, values))(angle), 0.0))


def _natural_slopes(x: Floats, y: Floats) -> Floats:
    """The slopes at its points of the natural cubic spline through points of the plane: its second derivative is
    continuous, and zero at the ends."""
    h = np.diff(x)
    rise = np.diff(y) / h
    system, right = np.zeros((len(x), len(x))), np.empty(len(x))
    system[0, :2], system[-1, -2:] = (2.0, 1.0), (1.0, 2.0)
    right[0], right[-1] = 3.0 * rise[0], 3.0 * rise[-1]
    for k in range(1, len(x) - 1):
        system[k, k - 1 : k + 2] = h[k], 2.0 * (h[k - 1] + h[k]), h[k - 1]
        right[k] = 3.0 * (h[k] * rise[k - 1] + h[k - 1] * rise[k])
    return linear_solution(system, right)


FINISHES: dict[str, Finish] = {
    "normal": Finish(),
    "metallic": Finish.polished(16.0, 0.5, 2.0),
    "shiny": Finish.polished(256.0, 0.5),
    "mat": Finish(exponent=0.5),
    "wood": Finish(exponent=0.7, diffuse=0.9),
    "plastic": Finish.polished(64.0, 0.5),
    "transparent": Finish.polished(256.0, 0.9),
    "mirror": Finish.polished(1024.0, 0.2),
    "unlit": Finish(),
}
"""What the words of scene.Material mean. Source: Glaeser, sections 4.5, figure 4, and 8.5, figure 18."""


def finish_of(material: Material) -> Finish:
    """The finish of a material: that of its word, but for the numbers that it gives itself."""
    return replace(FINISHES.get(material.word, Finish()), **material.own_finish)


def lambert(cosine: ArrayLike, exponent: float = 1.0) -> Floats:
    """The cosine of the angle between normal and light to some power; on the dark side 0.3 of what it is on the front.

    Parameters
    ----------
    cosine : (...) array_like of float
        Negative on the dark side.
    exponent : float
        1 for Lambert's law.

    Returns
    -------
    (...) array of float
        0 to 1.

    Notes
    -----
    Source: Glaeser, section 4.5, equation 2; erratum G4-08.

    Examples
    --------
    >>> from vectorplot.shading import lambert
    >>> lambert([1.0, 0.5, 0.0, -0.5]).tolist()
    [1.0, 0.5, 0.0, 0.15]
    """
    c = np.clip(np.asarray(cosine, dtype=np.float64), -1.0, 1.0)
    size = power(np.abs(c), exponent)
    return np.asarray(np.where(c > 0.0, size, DARK_SIDE * size))


def backlit(cosine: ArrayLike) -> Bools:
    """(...) whether light falls on the other side only. Light along the face does not light it."""
    return np.asarray(np.asarray(cosine) <= 0.0)


def facing(normals: ArrayLike, to_eye: ArrayLike) -> Floats:
    """(n, 3) the normals, turned to the side the eye is on: so the faces of hollow bodies are lit if eye and light are
    on the same side. Source: Glaeser, section 4.5."""
    n, e = np.asarray(normals, dtype=np.float64), np.asarray(to_eye, dtype=np.float64)
    return np.where(component_sum(n * e)[..., None] < 0.0, -n, n)


def reflected(normals: ArrayLike, to_light: ArrayLike) -> Floats:
    """The directions of reflected rays: 2 (n.l) n - l for unit vectors.

    Parameters
    ----------
    normals : (..., 3) array_like of float
        Unit vectors n.
    to_light : (..., 3) array_like of float
        Unit vectors l, to the light.

    Returns
    -------
    (..., 3) array of float
        Unit vectors, away from the surface.

    Notes
    -----
    Source: Glaeser, section 8.5, equation 30.

    Examples
    --------
    >>> from vectorplot.shading import reflected
    >>> reflected((0, 0, 1), (0.6, 0, 0.8)).tolist()
    [-0.6, 0.0, 0.8]
    """
    n, light = np.asarray(normals, dtype=np.float64), np.asarray(to_light, dtype=np.float64)
    return np.asarray(2.0 * (n * light).sum(axis=-1, keepdims=True) * n - light)


def brightness(cos_alpha: ArrayLike, cos_beta: ArrayLike, finish: Finish) -> Floats:
    """(...) what a surface sends to the eye of one light of intensity 1, 1 and more being the brightest. cos_alpha:
    between normal and light; cos_beta: between reflected ray and eye. Highlights only where light falls on the outer
    side and the reflected ray runs towards the eye. Source: Glaeser, section 8.5, equation 31; erratum G8-16.
    """
    alpha = np.clip(np.asarray(cos_alpha, dtype=np.float64), -1.0, 1.0)
    beta = np.clip(np.asarray(cos_beta, dtype=np.float64), -1.0, 1.0)
    bright = finish.diffuse * lambert(alpha, finish.exponent)
    if finish.highlight == 0.0:
        return np.asarray(bright)
    shining = (alpha > 0.0) & (beta > 0.0)
    peak = power(np.where(shining, beta, 0.0), finish.sharpness)
    return np.asarray(bright + finish.highlight * finish.weight_at(alpha) * peak)


def towards(points: ArrayLike, source: ArrayLike) -> Floats:
    """(n, 3) unit vectors from points (n, 3) to an eye or a lamp at (x, y, z, 1), or against parallel rays that come
    from the direction (x, y, z, 0). Edge cases: a point in the lamp has no direction: zeros."""
    p, s = np.asarray(points, dtype=np.float64), np.asarray(source, dtype=np.float64)
    if s.shape != (4,) or not np.isfinite(s).all():
        raise InputError("a light or an eye needs four finite homogeneous coordinates")
    ray = s[:3] - p if s[3] != 0.0 else np.broadcast_to(s[:3] / np.abs(s[:3]).max(initial=LEAST_DIVISOR), p.shape)
    length = norm(ray)
    return np.asarray(ray / np.where(length > 0.0, length, 1.0)[:, None])


def homogeneous_light(light: Light) -> tuple[float, float, float, float]:
    """Where a light of a scene is."""
    x, y, z = light.position
    return (x, y, z, 0.0 if light.parallel else 1.0)


def intensities(lights: Sequence[Light]) -> Floats:
    """(l,) the intensities of the lights; 1 / sqrt(l) for those that have none. Source: Glaeser, section 4.5."""
    usual = 1.0 / np.sqrt(max(len(lights), 1))
    given = np.array([usual if light.intensity is None else light.intensity for light in lights], dtype=np.float64)
    if not ((given >= 0.0) & (given < np.inf)).all():
        raise InputError("the intensity of a light must be a finite number that is not negative")
    return given


def light_cosines(
    points: Floats, normals: Floats, eye: ArrayLike | None, lights: Sequence[Light]
) -> tuple[Floats, Floats]:
    """Cosines of the angles at points (n, 3) that brightness is made of, each (l, n): between normal and light, and
    between reflected ray and eye; the latter are zeros without an eye, for what has no highlights."""
    to_eye = None if eye is None else towards(points, eye)
    alpha, beta = np.zeros((2, len(lights), len(points)))
    for row, light in enumerate(lights):
        to_light = towards(points, homogeneous_light(light))
        alpha[row] = component_sum(normals * to_light)
        if to_eye is not None:
            # The reflected ray against the direction to the eye, without the ray itself.
            along = component_sum(normals * to_eye)
            beta[row] = 2.0 * alpha[row] * along - component_sum(to_light * to_eye)
    return alpha, beta


def distance_factor(light_distance: float, depth: ArrayLike, nearest: float) -> Floats:
    """How much less light arrives at depths in a light's system than at the nearest one.

    depth: (...) larger = closer to the light; result: (...) the square of the ratio of distances, at most 1.
    Source: Glaeser, section 4.5, equation 4.
    """
    z = np.asarray(depth, dtype=np.float64)
    if not (nearest < light_distance and (z <= nearest).all()):
        raise InputError("a point is nearer to the light than the nearest one")
    return np.asarray(((light_distance - nearest) / (light_distance - z)) ** 2)


def depth_cue(depth: ArrayLike, minimum: float, total: float) -> Floats:
    """(...) 0 to 0.2: what ambient light adds to shades at depths (larger = closer) from minimum on, over total; all of
    it in a scene without depth. Source: Glaeser, section 4.5, equation 5, figure 6.
    """
    z = np.asarray(depth, dtype=np.float64)
    share = (z - minimum) / total if total > 0.0 else np.ones(z.shape)
    return np.asarray(AMBIENT * np.clip(share, 0.0, 1.0))


def shades(shares: ArrayLike, intensity: ArrayLike, cue: ArrayLike = 0.0) -> Floats:
    """(n,) or, in coloured light, (3,n) how bright points are in all lights together, 0 to 1. shares (l,n): of each
    light, see brightness; intensity (l,) or (l,3); cue (n,): of ambient light, see depth_cue. The sum of shares
    fills four fifths of the palette, and is cut off there; then comes the cue.
    Source: Glaeser, section 4.5, equations 3, 5 and 7; erratum G4-08.
    """
    total = matmul(np.asarray(intensity, dtype=np.float64).T, np.asarray(shares, dtype=np.float64))
    return np.asarray(np.clip(DIRECT_SHARE * np.minimum(total, 1.0) + np.asarray(cue), 0.0, 1.0))


def fitting_factor(shares: ArrayLike, intensity: ArrayLike) -> float:
    """What intensities (l,) or (l, 3) are taken times, so that the brightest point of shares (l, n) just reaches the
    end of the lights' part of the palette.

    For one picture; in a movie keep that of the first frame, or it flickers. Edge cases: in the dark it is 1.
    Source: Glaeser, section 4.5, equation 7.
    """
    most = float(
        (matmul(np.asarray(intensity, dtype=np.float64).T, np.asarray(shares, dtype=np.float64))).max(initial=0.0)
    )
    return 1.0 / most if most > 0.0 else 1.0


def shade_numbers(shade: ArrayLike, size: int) -> NDArray[np.uint8]:
    """(...) shades 0 to 1 as numbers 0 to size - 1 in a palette of so many, rounded once. Source: erratum G4-07."""
    if not 1 <= size <= 256:
        raise InputError(f"a palette of {size} shades: expected 1 to 256")
    s = np.asarray(shade, dtype=np.float64) * size
    return np.clip(np.floor(s + 0.5), 0, size - 1).astype(np.uint8)


# Light that becomes weaker with the distance from its lamp.
#
# Source: Glaeser, section 4.5, equation 4, figure 5, with distances in place of depths.

LEAST_REACH = 0.25
"""What is nearer to a lamp than this part of the distance of the farthest point keeps all of its light: else the lamp's
own bulb, or the ceiling it hangs from, would leave none for the rest. So nothing gets less than a sixteenth."""


def lamp_reach(view: View, light: Light) -> float:
    """How far from a lamp, in the view, light keeps what it has: as far as the nearest point of the faces, or a quarter
    of the way to the farthest. Edge cases: without end for light that does not fade, as parallel light never does,
    and for a scene without faces."""
    if not light.fading or light.parallel or not view.face_count:
        return np.inf
    corners = view.corners[ragged.fans(view.offsets)[0]]
    place = np.array(light.position)
    nearest = float(_distances(place, view.points, corners).min(initial=np.inf))
    arm = view.points - place[:, None]
    return max(nearest, LEAST_REACH * float(np.sqrt((arm * arm).sum(axis=0)).max()))


def fading_factors(light: Light, reach: float, points: Floats) -> Floats:
    """(n,) what part of its light a lamp sends to points (3,n): all of it within its reach, farther away less with the
    square of the distance."""
    if reach == np.inf:
        return np.ones(points.shape[1])
    arm = points - np.array(light.position)[:, None]
    far = np.maximum(np.sqrt((arm * arm).sum(axis=0)), reach)
    return distance_factor(0.0, -far, -reach)


def _distances(place: Floats, points: Floats, corners: Ints) -> Floats:
    """(t,) distances of a place from triangles (t,3) of points (3,n)."""
    a, b, c = (points[:, corners[:, k]] - place[:, None] for k in range(3))
    normal = np.cross(b - a, c - a, axis=0)
    size = np.sqrt((normal * normal).sum(axis=0))
    height = np.abs((normal * a).sum(axis=0)) / np.where(size > 0.0, size, 1.0)
    above = size > 0.0
    border = np.full(len(corners), np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        side = q - p
        length = (side * side).sum(axis=0)
        share = np.clip(-(p * side).sum(axis=0) / np.where(length > 0.0, length, 1.0), 0.0, 1.0)
        foot = p + share * side
        border = np.minimum(border, np.sqrt((foot * foot).sum(axis=0)))
        above &= (np.cross(p, q, axis=0) * normal).sum(axis=0) >= 0.0
    return np.where(above, height, border)


# Lines that fade with their depth.
#
# Source: Glaeser, section 4.4.

MIDDLE = 0.5
"""The shade of all edges without depth cueing, in the palette of their item."""

LEAST = 0.2
"""The shade of what is farthest away: the darkest fifth of a palette is not used."""


def depth_shades(depth: ArrayLike, farthest: float, nearest: float) -> Floats:
    """(...) shades from 0.2 for depths at the farthest limit, and beyond, to 1 at the nearest, and before it.

    Depths grow towards the eye. Edge cases: without depth between the limits everything is near.
    Source: Glaeser, section 4.4, figure 2; errata G4-03, G4-04.
    """
    z = np.asarray(depth, dtype=np.float64)
    if not nearest > farthest:
        return np.ones(z.shape)
    return np.asarray(LEAST + (1.0 - LEAST) * np.clip((z - farthest) / (nearest - farthest), 0.0, 1.0))


def edge_shades(start: ArrayLike, end: ArrayLike, farthest: float, nearest: float) -> Floats:
    """(...) the shades of edges with their ends at these depths: the mean of the shades of both.

    Source: Glaeser, section 4.4, figure 2; errata G4-03, G4-04.
    """
    both = depth_shades(start, farthest, nearest), depth_shades(end, farthest, nearest)
    return np.asarray((both[0] + both[1]) / 2.0)


# How dark shadows are.

LEVELS = 9
"""From light to shadow there are so many steps: those between them, one fewer, are the soft border of a shadow."""


def shadow_shades(
    shares: ArrayLike,
    intensity: ArrayLike,
    lacking: ArrayLike,
    cue: ArrayLike = 0.0,
    *,
    dimmed: ArrayLike = -1,
    step: ArrayLike = 1,
) -> Floats:
    """(n,) or (3,n) shades of points in shadows: half of what each absent light would give is taken away; without any
    light half of the face's shade is left, and the cue. shares, intensity, cue: see shades; lacking (n,): bit k for
    light k, see Decals; dimmed (n,): a light that is partly there, or -1; step (n,): how far into the border, 1 to
    LEVELS - 1.
    Edge cases: points that no light would reach keep their shade. Source: Glaeser, section 6.3; decision D-5.
    """
    strength = np.asarray(intensity, dtype=np.float64)
    if strength.ndim == 2:
        return np.stack([shadow_shades(shares, one, lacking, cue, dimmed=dimmed, step=step) for one in strength.T])
    given = np.asarray(shares, dtype=np.float64) * strength[:, None]
    number = np.arange(len(given))[:, None]
    gone = (np.asarray(lacking, dtype=np.int64)[None] >> number) & 1
    # In the middle of each step.
    part = (np.asarray(step)[None] - 0.5) / (LEVELS - 1)
    soft = np.where(np.asarray(dimmed)[None] == number, 1.0 - part * (1.0 - SHADOW_SHARE), 1.0)
    kept = np.where(gone == 1, SHADOW_SHARE, soft)
    total = given.sum(axis=0)
    left = (given * kept).sum(axis=0) / np.where(total > 0.0, total, 1.0)
    return np.asarray(np.clip(DIRECT_SHARE * np.minimum(total, 1.0) * left + np.asarray(cue), 0.0, 1.0))
