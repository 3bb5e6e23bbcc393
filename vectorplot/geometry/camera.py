"""Cameras: where one looks from and how, by central or parallel projection; panoramas and windows of pixels.

Source: Glaeser, section 2.2 and its table; errata G2-03, G2-15.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan, tan
from vectorplot.geometry.rotations import euler_angles, rotation_x, rotation_z, upright_turn
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances import NO_AZIMUTH_SINE, SAME_DIRECTION_SINE, VERTICAL_SINE

# Focal lengths of miniature cameras and fields of vision.

NEGATIVE_MM = (36.0, 24.0)
"""Width and height of a miniature camera's negative."""

NATURAL_DEG = (15.0, 40.0)
"""Fields of vision that look natural."""

WIDEST_DEG, NARROWEST_DEG = 60.0, 10.0
"""Wider fields distort; narrower ones look like a telephoto lens."""


def field_of_vision_deg(focal_length_mm: float) -> float:
    """The angle over the height of the picture of a miniature camera.

    Source: Glaeser, section 2.2 and its table; errata G2-03, G2-15.
    """
    return _angle_deg(NEGATIVE_MM[1], focal_length_mm)


def diagonal_field_of_vision_deg(focal_length_mm: float) -> float:
    """The angle over the diagonal of the picture of a miniature camera.

    Source: Glaeser, section 2.2 and its table; errata G2-03, G2-15.
    """
    return _angle_deg(float(np.hypot(*NEGATIVE_MM)), focal_length_mm)


def focal_length_mm(fov_deg: float) -> float:
    """The focal length of a miniature camera with some angle over the height of the picture.

    fov_deg: in degrees; result: in mm.
    Source: Glaeser, section 2.2 and its table; errata G2-03, G2-15.
    Errors: for an angle that is not between 0 and 180 degrees.
    """
    if not 0.0 < fov_deg < 180.0:
        raise InputError(f"field of vision {fov_deg:g} must lie between 0 and 180 degrees")
    return NEGATIVE_MM[1] / 2.0 / float(tan(np.radians(fov_deg) / 2.0))


def lens_advice(fov_deg: float) -> str | None:
    """One line about a field of vision that will not look natural.

    Source: Glaeser, section 2.2.
    """
    natural = f"{NATURAL_DEG[0]:g} to {NATURAL_DEG[1]:g} degrees look natural"
    if fov_deg > WIDEST_DEG:
        return f"a field of vision of {fov_deg:g} degrees distorts; {natural}"
    if fov_deg < NARROWEST_DEG:
        return f"a field of vision of {fov_deg:g} degrees is that of a telephoto lens; {natural}"
    return None


def _angle_deg(size_mm: float, focal_mm: float) -> float:
    if not 0.0 < focal_mm < np.inf:
        raise InputError(f"focal length {focal_mm:g} mm must be positive and finite")
    return float(np.degrees(2.0 * arctan(size_mm / 2.0 / focal_mm)))


# Where one looks from, and how: central and parallel projection alike.

Point = tuple[float, float, float]

VIEWS: dict[str, tuple[Point, Point]] = {
    "front": ((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
    "back": ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    "left": ((-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "right": ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "top": ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    "bottom": ((0.0, 0.0, -1.0), (0.0, -1.0, 0.0)),
    "iso": ((1.0, -1.0, 1.0), (0.0, 0.0, 1.0)),
}
"""Main views: direction from the target to the eye, and the direction that is up in the picture."""


@dataclass(frozen=True)
class Camera:
    """An eye, the target it looks at, and the projection.

    Parameters
    ----------
    eye, target : (float, float, float)
        In world coordinates.
    up : (float, float, float), optional
        A direction that is up in the picture; without it z is up (straight from above or below: as if the eye stood on
        the positive x-axis).
    twist_deg : float
        Turns the camera about its principal ray, on top of either, in degrees.
    fov_deg : float
        The full angle over the picture height, in degrees.
    parallel : bool
        Rays parallel to eye - target.
    height : float, optional
        The height of the picture in world units where rays are parallel (None: as the central projection from this eye
        would have in the plane through the target).
    near, far : float, optional
        How far from the eye, along the line to the target, what is seen begins and ends (None: all before the eye).

    Raises
    ------
    InputError
        For an eye in the target, an up vector without length or along the view, a field of vision outside 0 to 180
        degrees, a height that is not positive, planes that leave nothing, and numbers that are not finite.

    Notes
    -----
    Source: Glaeser, section 2.1, equations 1 to 5; the twist is his tau.

    Examples
    --------
    >>> import vectorplot as vp
    >>> camera = vp.Camera((0, -4, 0), target=(0, 0, 0), fov_deg=40)
    >>> camera.distance
    4.0
    >>> vp.Camera.view("top").up
    (0.0, 1.0, 0.0)
    """

    eye: Point
    target: Point = (0.0, 0.0, 0.0)
    up: Point | None = None
    twist_deg: float = 0.0
    fov_deg: float = 30.0
    parallel: bool = False
    height: float | None = None
    near: float | None = None
    far: float | None = None

    def __post_init__(self) -> None:
        for name in ("eye", "target", "up"):
            value = getattr(self, name)
            if isinstance(value, str):
                raise InputError(f"camera: {name} must be three numbers; a main view is vp.Camera.view({value!r})")
            if value is not None:
                point = tuple(float(x) for x in value)
                if len(point) != 3 or not all(np.isfinite(point)):
                    raise InputError(f"camera: {name} must be three finite numbers")
                object.__setattr__(self, name, point)
        if not np.isfinite(self.twist_deg):
            raise InputError("camera: twist must be a finite number of degrees")
        if not 0.0 < self.fov_deg < 180.0:
            raise InputError(f"camera: field of vision {self.fov_deg:g} must lie between 0 and 180 degrees")
        if self.height is not None and not 0.0 < self.height < np.inf:
            raise InputError(f"camera: height {self.height:g} must be positive and finite")
        for name in ("near", "far"):
            depth = getattr(self, name)
            if depth is not None and not 0.0 < depth < np.inf:
                raise InputError(f"camera: {name} {depth:g} must be positive and finite")
        if self.near is not None and self.far is not None and not self.near < self.far:
            raise InputError(f"camera: near {self.near:g} must be less than far {self.far:g}")
        if self.eye == self.target or not self.distance > 0.0:
            raise InputError("camera: the eye is in the target")
        if self.up is not None:
            length = float(norm(_direction_upwards(self.up)))
            across = norm(np.cross(self.up, self.direction))
            if not across > SAME_DIRECTION_SINE * length:
                raise InputError("camera: the up vector lies along the view")

    @cached_property
    def distance(self) -> float:
        """From the eye to the target, in world units."""
        return math.dist(self.eye, self.target)

    @cached_property
    def direction(self) -> Floats:
        """(3,) unit vector from the target to the eye."""
        ray = np.subtract(self.eye, self.target)
        ray = ray / np.abs(ray).max()
        return np.asarray(ray / norm(ray), dtype=np.float64)

    @cached_property
    def axes(self) -> Floats:
        """(3,3) rows: right, up, and back towards the eye, unit vectors in world coordinates; right-handed."""
        back = self.direction
        if self.up is not None:
            right = np.cross(self.up, back)
        elif np.hypot(back[0], back[1]) <= VERTICAL_SINE:
            right = np.array([0.0, 1.0, 0.0])
        else:
            right = np.array([-back[1], back[0], 0.0])
        right = right / norm(right)
        upward = np.cross(back, right)
        angle = np.radians(self.twist_deg)
        cos, sin = np.cos(angle), np.sin(angle)
        return np.array([cos * right + sin * upward, cos * upward - sin * right, back])

    @property
    def picture_height(self) -> float:
        """Height of the picture in world units, in the plane through the target that faces the eye."""
        if self.parallel and self.height is not None:
            return self.height
        return 2.0 * self.distance * float(tan(np.radians(self.fov_deg) / 2.0))

    @property
    def euler_angles(self) -> tuple[float, float, float]:
        """The angles alpha, beta, gamma in radians: the twist, from the zenith, a quarter turn more than the azimuth.

        With an up vector that is not vertical alpha is the twist that does the same. The rows of axes are
        Z(alpha) X(beta) Z(gamma). Source: Glaeser, section 2.1, equations 1 to 3 and 10; erratum G2-01.
        """
        return euler_angles(self.axes)

    @classmethod
    def from_euler(
        cls,
        distance: float,
        alpha: float,
        beta: float,
        gamma: float,
        target: Point = (0.0, 0.0, 0.0),
        *,
        fov_deg: float = 30.0,
        parallel: bool = False,
        height: float | None = None,
    ) -> Camera:
        """The camera that sees what a camera at (0, 0, distance) sees of a turned scene, with its target in the origin.

        Parameters
        ----------
        distance : float
            From the eye to the target, in world units.
        alpha, beta, gamma : float
            The scene is turned by alpha about z, beta about x and gamma about z. In radians, any numbers.
        target : (float, float, float)
            In world coordinates.
        fov_deg, parallel, height : optional
            See Camera.

        Returns
        -------
        Camera
            With an up vector near the zenith, elsewhere with a twist.

        Raises
        ------
        InputError
            For a distance that is not positive and finite, angles that are not finite, and what Camera refuses.

        Notes
        -----
        Source: Glaeser, section 2.1, equations 9 and 10.

        Examples
        --------
        >>> import vectorplot as vp
        >>> camera = vp.Camera.from_euler(5.0, 0.0, 0.0, 0.0)
        >>> camera.eye, camera.up
        ((0.0, 0.0, 5.0), (0.0, 1.0, 0.0))
        """
        if not (0.0 < distance < np.inf and np.isfinite((alpha, beta, gamma)).all()):
            raise InputError("camera: distance and angles must be finite numbers, the distance positive")
        axes = matmul(matmul(rotation_z(alpha), rotation_x(beta)), rotation_z(gamma))
        x, y, z = (float(t) + distance * float(w) for t, w in zip(target, axes[2], strict=True))
        # Near the zenith the eye's azimuth has no digits: there the up vector says how the picture stands.
        upright = float(np.hypot(axes[2, 0], axes[2, 1])) < NO_AZIMUTH_SINE
        up = (float(axes[1, 0]), float(axes[1, 1]), float(axes[1, 2])) if upright else None
        twist = 0.0 if upright else float(np.degrees(euler_angles(axes)[0]))
        return cls((x, y, z), target, up, twist, fov_deg, parallel, height)

    @classmethod
    def from_focal_length(
        cls, focal_length_mm: float, eye: Point, target: Point = (0.0, 0.0, 0.0), *, twist_deg: float = 0.0
    ) -> Camera:
        """The camera with the field of vision of a miniature camera (24 x 36 mm) with this lens.

        Parameters
        ----------
        focal_length_mm : float
            Of the lens, in mm.
        eye, target : (float, float, float)
            In world coordinates.
        twist_deg : float
            See Camera.

        Returns
        -------
        Camera
            A central projection; the field of vision is that over the height of the negative.

        Raises
        ------
        InputError
            For a focal length that is not positive and finite, and for what Camera refuses.

        Notes
        -----
        Source: Glaeser, section 2.2, table; erratum G2-15.

        Examples
        --------
        >>> import vectorplot as vp
        >>> round(vp.Camera.from_focal_length(50.0, (0, -9, 0)).fov_deg, 3)
        26.991
        """
        return cls(eye, target, twist_deg=twist_deg, fov_deg=field_of_vision_deg(focal_length_mm))

    @classmethod
    def view(
        cls, name: str, target: Point = (0.0, 0.0, 0.0), distance: float = 1.0, up: Point = (0.0, 0.0, 1.0)
    ) -> Camera:
        """A main view (front, back, left, right, top, bottom) or iso: a parallel projection.

        Parameters
        ----------
        name : {"front", "back", "left", "right", "top", "bottom", "iso"}
            Which view.
        target : (float, float, float)
            In world coordinates.
        distance : float
            From the eye to the target, in world units.
        up : (float, float, float)
            Along what things stand upright: with y the front is where z is largest, with z where y is smallest. Views
            are turned with it on the shortest way from z.

        Returns
        -------
        Camera
            With parallel rays and an up vector.

        Raises
        ------
        InputError
            For another name, and for what Camera refuses.

        Notes
        -----
        Source: Glaeser, section 2.1 and appendix A.3, keys 1 to 6.

        Examples
        --------
        >>> import vectorplot as vp
        >>> front = vp.Camera.view("front", distance=3.0)
        >>> front.eye, front.parallel
        ((0.0, -3.0, 0.0), True)
        """
        if name not in VIEWS:
            raise InputError(f"view {name!r}: expected one of {', '.join(VIEWS)}")
        turn = upright_turn(_direction_upwards(up))
        direction, upwards = (matmul(np.array(one), turn) for one in VIEWS[name])
        ray = direction * (distance / norm(direction))
        x, y, z = (upwards + 0.0).tolist()
        eye = (target[0] + ray[0], target[1] + ray[1], target[2] + ray[2])
        return cls(eye=eye, target=target, up=(x, y, z), parallel=True)


def _direction_upwards(up: Point) -> Point:
    """An up vector, as it is. Errors: InputError for one without length."""
    if not any(up):
        raise InputError("camera: the up vector has no length: expected a direction such as 0,1,0")
    return up


# Where somebody stands who looks all round, and which part of the round a picture shows.

MOST_STRIPS = 36
"""Strips that a panorama is cut into, at most."""

STEEPEST_DEG = 80.0
"""Elevations are shown up to this angle: on the page what is higher is wider and wider."""


@dataclass(frozen=True)
class Panorama:
    """Somebody who looks all round, in place of a camera: bearings run evenly along the page, elevations up it.

    Parameters
    ----------
    place : (float, float, float) or (float, float)
        The eye, in world coordinates; or x and y of a place on a terrain, above which the eye is.
    above : float, optional
        How high above the terrain the eye is, where the place has no height; a five-hundredth of the width of the scene
        where None.
    middle_deg : float
        The bearing in the middle of the picture, clockwise from north, which is along y: 180 is south.
    width_deg : float
        How much of the round is shown; more than 0, at most 360.
    strips : int, optional
        Into how many strips, one below the other, the picture is cut, 1 to 36; where None as many as make it largest.
    lowest_deg, highest_deg : float
        Elevations between which lines are shown; between -80 and 80.

    Raises
    ------
    InputError
        For numbers out of range, or that are not finite.

    Notes
    -----
    A straight line of the world is no straight line on the page: the tangent of its elevation is a sine of the bearing.
    Circles of equal elevation, the horizon among them, are straight.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Panorama((3.0, 4.0)).bearings_deg
    (0.0, 360.0)
    """

    place: tuple[float, ...]
    above: float | None = None
    middle_deg: float = 180.0
    width_deg: float = 360.0
    strips: int | None = None
    lowest_deg: float = -20.0
    highest_deg: float = 60.0

    def __post_init__(self) -> None:
        place = tuple(float(x) for x in self.place)
        if len(place) not in (2, 3) or not np.isfinite(place).all():
            raise InputError("panorama: expected a place of two or three finite numbers")
        object.__setattr__(self, "place", place)
        if self.above is not None and not np.isfinite(self.above):
            raise InputError("panorama: expected a finite height above the terrain")
        if self.above is not None and len(place) > 2:
            raise InputError("panorama: a place with a height is above nothing; expected x and y only")
        if not np.isfinite(self.middle_deg):
            raise InputError("panorama: expected a finite bearing in the middle")
        if not 0.0 < self.width_deg <= 360.0:
            raise InputError(f"panorama: {self.width_deg:g} degrees wide, expected more than 0 and at most 360")
        if self.strips is not None and not 1 <= self.strips <= MOST_STRIPS:
            raise InputError(f"panorama: {self.strips} strips, expected 1 to {MOST_STRIPS}")
        if not -STEEPEST_DEG <= self.lowest_deg < self.highest_deg <= STEEPEST_DEG:
            raise InputError(
                f"panorama: elevations from {self.lowest_deg:g} to {self.highest_deg:g} degrees, expected them to rise "
                f"from {-STEEPEST_DEG:g} to {STEEPEST_DEG:g} at most"
            )

    @property
    def bearings_deg(self) -> tuple[float, float]:
        """The bearings at the left and at the right end."""
        return self.middle_deg - 0.5 * self.width_deg, self.middle_deg + 0.5 * self.width_deg


# Windows of pixels.


@dataclass(frozen=True)
class PixelWindow:
    """A window of width x height pixels.

    width, height: in pixels; pixel_ratio: what a unit upwards is in pixels against one to the right.
    """

    width: float
    height: float
    pixel_ratio: float = 1.0

    def __post_init__(self) -> None:
        if not (0.0 < self.width < np.inf and 0.0 < self.height < np.inf and 0.0 < abs(self.pixel_ratio) < np.inf):
            raise InputError(f"a window of {self.width:g} x {self.height:g} pixels shows nothing")

    def normalized(self, pixels: ArrayLike) -> Floats:
        """Normalised device coordinates of pixels.

        pixels: (..., 2 or more) further columns do not matter; result: (..., 2) 0 to 1 from left to right and from the
        bottom to the top of the picture.
        Source: Glaeser, section 2.3, equation 13, with the correction of erratum G2-02.
        """
        p = np.asarray(pixels, dtype=np.float64)[..., :2]
        half = np.array([self.width, self.height]) / 2.0
        return np.asarray(0.5 + (p - half) / (2.0 * half * np.array([1.0, np.sign(self.pixel_ratio)])))
