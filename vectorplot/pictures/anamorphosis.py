"""The verb anamorphosis: drawings to lay around a mirror, or to look at aslant, so that they are seen undistorted."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.bezier import bezier_points, bezier_tangents, split
from vectorplot.drawing.drawing import STROKES, CurvedStrokes, Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.labels import NO_ITEM
from vectorplot.drawing.letters import lettered
from vectorplot.drawing.sheets import moved_mark
from vectorplot.drawing.stroke_curves import CHORD_SHARE, curved_strokes, one_mark
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import may_stop, threads_of
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.chord_refinement import Traces, refined, straight_between
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import closed_round, take
from vectorplot.geometry.vectors import cross, dot, norm, normalize
from vectorplot.io.anything import scene_of
from vectorplot.pictures.draw import draw
from vectorplot.pictures.options import check_options
from vectorplot.pictures.pipeline import Pipeline, Stage, StageReport, stoppable
from vectorplot.scene.page import Page
from vectorplot.scene.placement import PageAtScale, page_of
from vectorplot.scene.scene import Scene
from vectorplot.tolerances import COINCIDENT_MM, LEAST_DIVISOR, LEAST_TOLERANCE_MM, NO_AZIMUTH_SINE
from vectorplot.words import LineKind, check_word

# The mirror on the paper.

MIRRORS = ("cylinder", "cone", "none")
"""The kinds of mirrors; none: the paper itself is looked at, aslant."""


@dataclass(frozen=True)
class CurvedMirror:
    """A mirror of revolution about the z axis that stands on the paper, the plane z = 0, in mm.

    kind: one of MIRRORS; radius: of its foot; height: of its upper rim or its tip, infinite where a cylinder has none.
    A cylinder and a cone are x^2 + y^2 = constant + linear z + square z^2. Errors: InputError for another kind, and a
    cone that is no higher than wide: it sends what comes from above into the sky.
    """

    kind: str
    radius: float
    height: float

    def __post_init__(self) -> None:
        check_word("mirror", self.kind, MIRRORS)
        if self.kind == "cone" and not self.radius < self.height < np.inf:
            raise InputError(
                f"mirror: a cone of radius {self.radius:g} mm, {self.height:g} mm high, is too flat to show the paper: "
                f"make it higher than {self.radius:g} mm"
            )

    @property
    def profile(self) -> tuple[float, float, float]:
        """constant, linear and square."""
        if self.kind == "cylinder":
            return self.radius**2, 0.0, 0.0
        slope = self.radius / self.height
        return self.radius**2, -2.0 * slope * self.radius, slope**2

    def seen(self, eye: Floats, ways: Floats) -> Floats:
        """(k,3) where the ways (k,3) from an eye (3,) first meet the outside of the mirror; not finite where they miss
        it. Without a mirror the eye itself: nothing turns the ways."""
        if self.kind == "none":
            return np.broadcast_to(eye, ways.shape)
        constant, linear, square = self.profile
        level = ways[:, :2]
        with np.errstate(all="ignore"):
            a = dot(level, level) - square * ways[:, 2] ** 2
            b = dot(level, eye[:2]) - (0.5 * linear + square * eye[2]) * ways[:, 2]
            c = float(dot(eye[:2], eye[:2])) - constant - linear * float(eye[2]) - square * float(eye[2]) ** 2
            # The sum of two numbers of one sign: no digits are lost.
            q = -(b + np.where(b < 0.0, -1.0, 1.0) * np.sqrt(b * b - a * c))
            found = np.full(len(ways), np.inf)
            for far in (q / a, c / q):
                place = eye + far[:, None] * ways
                good = (far > 0.0) & (place[:, 2] >= 0.0) & (place[:, 2] <= self.height)
                good &= dot(ways, self.normals(place)) < 0.0
                found = np.where(good & (far < found), far, found)
            return np.asarray(np.where(np.isfinite(found)[:, None], eye + found[:, None] * ways, np.nan))

    def normals(self, places: Floats) -> Floats:
        """(k,3) vectors that point out of the mirror at places (k,3) of it, of no particular length."""
        _, linear, square = self.profile
        return np.column_stack([places[:, :2], -0.5 * linear - square * places[:, 2]])

    def on_paper(self, eye: Floats, ways: Floats) -> Floats:
        """(k,2) the points of the paper that are seen in the mirror along ways (k,3) from an eye (3,); not finite where
        a way misses the mirror, or leads from it into the sky."""
        return self.on_paper_with_slopes(eye, ways, np.zeros_like(ways))[0]

    def on_paper_with_slopes(self, eye: Floats, ways: Floats, turns: Floats) -> tuple[Floats, Floats]:
        """The same, and (k,2) how fast these points move where the ways change by turns (k,3)."""
        place = self.seen(eye, ways)
        with np.errstate(all="ignore"):
            if self.kind == "none":
                moved, ahead, turned = np.zeros_like(ways), ways, turns
            else:
                square = self.profile[2]
                normal = self.normals(place)
                facing, size = dot(ways, normal), dot(normal, normal)
                far = (dot(place - eye, ways) / dot(ways, ways))[:, None]
                # The place stays on the mirror: it moves across its normal.
                along = -far[:, 0] * dot(normal, turns) / facing
                moved = along[:, None] * ways + far * turns
                bent = np.column_stack([moved[:, :2], -square * moved[:, 2]])
                double = 2.0 * facing / size
                faster = 2.0 * (dot(turns, normal) + dot(ways, bent) - double * dot(normal, bent)) / size
                ahead = ways - double[:, None] * normal
                turned = turns - faster[:, None] * normal - double[:, None] * bent
            down = place[:, 2] / ahead[:, 2]
            lower = (moved[:, 2] - down * turned[:, 2]) / ahead[:, 2]
            points = place - down[:, None] * ahead
            slopes = moved - lower[:, None] * ahead - down[:, None] * turned
            lost = ~(ahead[:, 2] < 0.0)
        points[lost], slopes[lost] = np.nan, np.nan
        return points[:, :2], slopes[:, :2]


VIEWER = {"cylinder": (0.0, -16.0, 14.0), "cone": (0.0, 0.0, 16.0)}
"""From where one looks into a mirror unless said otherwise, in radii of it."""

VIEWER_MM = (0.0, -400.0, 150.0)
"""From where one looks at the paper without a mirror unless said otherwise."""

CONE_HEIGHT = 2.0
"""Of a cone, in radii, unless said otherwise: the paper around it is used as far as 2.7 radii from its axis."""

FILLED = {"cylinder": 0.75, "cone": 0.9, "none": 0.6}
"""Of the largest picture that a mirror can show, how large it is unless said otherwise: at the sides of a cylinder it
is enlarged without end."""

MOST_HIGH = 3.0
"""Of a cylinder, in radii, such a picture is no higher."""

OF_DISTANCE = 0.2
"""Of the distance of the eye, without a mirror, such a picture is no larger."""

ABOVE_FOOT = 0.2
"""How high above the foot of a cylinder the picture begins, in radii."""

OF_DRAWING = 0.4
"""The part of the tolerance for the drawing that is shown; the rest is for what becomes of its lines."""

ENLARGED, MOST_ENLARGED = 8.0, 32.0
"""How much the paper enlarges a picture is taken for before it is known, and how much is drawn finer for at most: near
the tip of a cone it grows without end, and no error is seen there."""

LARGER = 1.25
"""A drawing that the paper enlarges more than it was drawn for is drawn again for so many times as much as is known."""

SIZE_HALVINGS, HEIGHT_HALVINGS = 24, 40
"""Until it is known how large a picture may be, to the digits that are told, and how high it is, to a billionth of a
mm."""

OUTLINE_POINTS = 256
"""Of the convex hull of a picture, which tell whether all of it is seen."""

SAMPLES = 4096
"""Points of a drawing that tell how much it is enlarged."""

MOST_MM = 1e6
"""Of a mirror, and of the way to the eye: a page is no larger."""

MOST_POINTS = float(1 << 22)
"""On all strokes together."""

LETTERS_MM, GAP_MM, CROSS_MM, ARROW_MM = 2.5, 4.0, 6.0, 10.0
"""The height of letters, what is between them and the picture, and the sizes of the marks."""

FIELD = 1.0
"""Half the side of what is shown as seen, in distances of the eye: 45 degrees to each side. What lies beside the viewer
would be shown without end."""

FOOT_POINTS, FINE_POINTS = 96, 720
"""On the circle in which a mirror stands: as an arc on the paper, and where it is seen from the eye."""

MARK_PEN = Pen(0.18)
"""What draws where the mirror and the eye are."""


# What one looks into, and from where.


@dataclass(frozen=True)
class AnamorphicMirror:
    """The mirror that unbends an anamorphosis, from where one looks into it, and how large the picture seems in it.

    Parameters
    ----------
    kind : {"cylinder", "cone", "none"}
        A cylinder that stands on the paper, a cone that is looked at from above its tip, or no mirror: then the paper
        is looked at from a low eye, aslant.
    radius_mm : float
        Of the foot of the mirror.
    height_mm : float, optional
        Of the mirror: where None a cylinder is as high as it has to be, which the drawing says, and a cone is twice as
        high as its radius.
    viewer : (3,) sequence of float, optional
        The eye, in mm from the middle of the mirror's foot: to the right, away from the lower edge of the page, and
        above the paper; where None (0, -16, 14) radii for a cylinder, (0, 0, 16) for a cone, and (0, -400, 150) mm
        without a mirror.
    seen_mm : float, optional
        How long the longer side of the picture seems to be, where it seems to stand in the axis of the mirror; where
        None as suits the mirror.

    Raises
    ------
    InputError
        For another kind, lengths that are not positive, a cone not higher than its radius, and an eye that cannot look
        into the mirror.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.AnamorphicMirror("cone", radius_mm=20).eye.tolist()
    [0.0, 0.0, 320.0]
    """

    kind: str = "cylinder"
    radius_mm: float = 25.0
    height_mm: float | None = None
    viewer: Sequence[float] | None = None
    seen_mm: float | None = None

    def __post_init__(self) -> None:
        check_options({"mirror": self.kind, **vars(self)})
        for name, value in (("radius", self.radius_mm), ("height", self.height_mm)):
            if value is not None and not 0.0 < value <= MOST_MM:
                raise InputError(f"mirror: expected a positive {name} of at most {MOST_MM:.0f} mm, got {value:g}")
        mirror, eye = self.curved, self.eye
        if eye.shape != (3,) or not (np.abs(eye) <= MOST_MM).all():
            raise InputError(f"viewer: expected three finite numbers of mm, at most {MOST_MM:.0f}, got {self.viewer!r}")
        shown = ",".join(f"{value:g}" for value in eye.tolist())
        if not eye[2] > 0.0:
            raise InputError(f"viewer {shown}: expected an eye above the paper, at a height of more than 0 mm")
        if mirror.kind == "cylinder" and float(norm(eye[:2])) <= mirror.radius:
            raise InputError(
                f"viewer {shown}: expected an eye beside the cylinder, more than {mirror.radius:g} mm off its axis"
            )
        if mirror.kind == "cone" and not eye[2] > mirror.height:
            raise InputError(
                f"viewer {shown}: expected an eye above the tip of the cone, higher than {mirror.height:g} mm"
            )

    @property
    def curved(self) -> CurvedMirror:
        """The mirror itself, with its usual height where none is given."""
        usual = CONE_HEIGHT * self.radius_mm if self.kind == "cone" else np.inf
        return CurvedMirror(self.kind, self.radius_mm, usual if self.height_mm is None else self.height_mm)

    @property
    def eye(self) -> Floats:
        """(3,) from where one looks."""
        if self.viewer is None:
            return np.array(VIEWER_MM) if self.kind == "none" else self.radius_mm * np.array(VIEWER[self.kind])
        try:
            return np.asarray(self.viewer, dtype=np.float64)
        except (TypeError, ValueError):
            return np.zeros(0)


# Where the picture seems to stand.


@dataclass(frozen=True, eq=False)
class Setting:
    """How a drawing is looked at: by an eye (3,), in a mirror on the paper; it seems to stand in a plane through centre
    (3,), across the line of sight, its x axis along right and its y axis along up (3,), scale times as large, with its
    middle (2,) in the centre. All in mm; the axis of the mirror is the z axis."""

    mirror: CurvedMirror
    eye: Floats
    centre: Floats
    right: Floats
    up: Floats
    scale: float
    middle: Floats

    @classmethod
    def around(cls, mirror: CurvedMirror, eye: Floats, height: float, scale: float, middle: Floats) -> Setting:
        """With the centre at some height in the axis."""
        centre = np.array([0.0, 0.0, height])
        sight = normalize(centre - eye)
        across = cross(sight, np.array([0.0, 0.0, 1.0]))
        right = normalize(across) if norm(across) > NO_AZIMUTH_SINE else np.array([1.0, 0.0, 0.0])
        return cls(mirror, eye, centre, right, cross(right, sight), scale, middle)

    def ways(self, points: Floats) -> Floats:
        """(k,3) from the eye to where points (k,2) of the drawing seem to be."""
        return (self.centre - self.eye) + self.turns(points - self.middle)

    def turns(self, steps: Floats) -> Floats:
        """(k,3) what steps (k,2) in the drawing are where it seems to stand."""
        large = self.scale * steps
        return large[:, :1] * self.right + large[:, 1:] * self.up

    def on_paper(self, points: Floats) -> Floats:
        """(k,2) where points (k,2) of the drawing are on the paper; not finite where the mirror does not show them."""
        return self.mirror.on_paper(self.eye, self.ways(points))

    def slopes(self, points: Floats, steps: Floats) -> Floats:
        """(k,2) what steps (k,2) at points (k,2) of the drawing are on the paper."""
        return self.mirror.on_paper_with_slopes(self.eye, self.ways(points), self.turns(steps))[1]

    def heights(self, points: Floats) -> Floats:
        """(k,) how high on the mirror points (k,2) of the drawing are seen."""
        return self.mirror.seen(self.eye, self.ways(points))[:, 2]

    def enlargement(self, points: Floats) -> float:
        """How many times longer a short line at one of points (k,2) of the drawing is on the paper, at most."""
        x, y = (self.slopes(points, np.broadcast_to(axis, points.shape)) for axis in np.eye(2))
        # The larger singular value of the matrix with these columns.
        half = 0.5 * (dot(x, x) + dot(y, y))
        area = cross(x, y)
        squares = half + np.sqrt(np.maximum(half * half - area * area, 0.0))
        return float(np.sqrt(squares.max(initial=0.0)))


def _fitted(mirror: CurvedMirror, eye: Floats, outline: Floats, seen_mm: float | None) -> Setting:
    """How a drawing with an outline (k,2) is looked at, its longer side seen_mm long, or as long as suits the mirror.

    Errors: InputError for a picture that the mirror does not show as a whole, with how large it may be.
    """
    low, high = outline.min(axis=0), outline.max(axis=0)
    outline = _hull(outline)
    middle, long = 0.5 * (low + high), float((high - low).max())
    if not 0.0 < long < np.inf:
        raise InputError("anamorphosis: all of the picture is one point, or it has no end")

    def at(scale: float) -> Setting:
        return _at_height(mirror, eye, outline, scale, middle)

    def shows(scale: float) -> bool:
        return bool(np.isfinite(at(scale).on_paper(outline)).all())

    # A picture as large as this reaches beyond all mirrors, and without one above the horizon.
    most = 4.0 * (float(norm(eye)) if mirror.kind == "none" else mirror.radius) / long
    if mirror.kind == "cylinder":
        # A narrow one may be higher than the mirror is wide.
        most = max(most, 2.0 * float(eye[2]) / long)
    least = 0.0
    for _ in range(SIZE_HALVINGS):
        half = 0.5 * (least + most)
        least, most = (half, most) if shows(half) else (least, half)
    if seen_mm is None:
        scale = FILLED[mirror.kind] * least
        if mirror.kind == "cylinder":
            scale = min(scale, MOST_HIGH * mirror.radius / max(float(high[1] - low[1]), LEAST_DIVISOR))
        elif mirror.kind == "none":
            scale = min(scale, OF_DISTANCE * float(norm(eye)) / long)
    else:
        scale = seen_mm / long
    if not (scale > 0.0 and shows(scale)):
        where = "seen from there" if mirror.kind == "none" else f"in the {mirror.kind}"
        if not least * long > COINCIDENT_MM:
            seen = where.removeprefix("seen ")
            raise InputError(f"nothing can be seen {seen}: look from higher up, or make the mirror higher")
        raise InputError(
            f"a picture of {scale * long:.4g} mm does not fit {where}, its longer side may have {least * long:.4g} mm"
        )
    return at(scale)


def _hull(points: Floats) -> Floats:
    """(k,2) corners of the convex hull of points (n,2), evenly chosen where they are many."""
    import shapely

    corners = shapely.get_coordinates(shapely.convex_hull(shapely.multipoints(points)))
    return np.asarray(corners[:: 1 + len(corners) // OUTLINE_POINTS])


def _at_height(mirror: CurvedMirror, eye: Floats, outline: Floats, scale: float, middle: Floats) -> Setting:
    """As it looks with the foot of the outline (k,2) just above that of a cylinder, or in the foot of other mirrors."""
    if mirror.kind != "cylinder":
        return Setting.around(mirror, eye, 0.0, scale, middle)
    foot = ABOVE_FOOT * mirror.radius
    endless = replace(mirror, height=np.inf)
    low, high = 0.0, float(eye[2])
    for _ in range(HEIGHT_HALVINGS):
        half = 0.5 * (low + high)
        heights = Setting.around(endless, eye, half, scale, middle).heights(outline)
        # What is seen below the foot is not seen at all.
        low, high = (low, half) if (heights >= foot).all() else (half, high)
    return Setting.around(mirror, eye, high, scale, middle)


# Strokes on the paper.


@dataclass(frozen=True, eq=False)
class Curves:
    """Strokes as cubic curves: control (k,4,2), one after the other; offsets (m+1,): stroke i has the curves offsets[i]
    to offsets[i+1]; source (m,): of which stroke of a drawing each is a part; closed, smooth (m,)."""

    control: Floats
    offsets: Ints
    source: Ints
    closed: Bools
    smooth: Bools

    @classmethod
    def of(cls, strokes: CurvedStrokes) -> Curves:
        """Those of a drawing, of straight lines too."""
        paths, beziers = strokes.paths, strokes.beziers
        size, bent = np.diff(paths.offsets), np.diff(beziers.offsets)
        straight = np.where(bent > 0, 0, np.maximum(size - 1 + paths.closed, 0))
        stroke, place = ragged.owner(straight), ragged.place(straight)
        first = paths.offsets[stroke] + place
        last = paths.offsets[stroke] + (place + 1) % np.maximum(size[stroke], 1)
        ends = np.stack([paths.points[first], paths.points[last]], axis=1)
        thirds = ends[:, :1] + np.arange(4.0)[None, :, None] / 3.0 * (ends[:, 1:] - ends[:, :1])
        thirds[:, 3] = ends[:, 1]
        owner = np.concatenate([stroke, ragged.owner(bent)])
        order = np.argsort(owner, kind="stable")
        control = np.concatenate([thirds, beziers.control])[order]
        count = straight + bent
        kept = np.flatnonzero(count > 0)
        return cls(
            control, ragged.offsets(count[kept]), kept, paths.closed[kept], (bent > 0)[kept] | paths.smooth[kept]
        )

    def without(self, place: Floats, radius: float) -> Curves:
        """Without what is nearer to a place (2,) than a radius, or just a little farther: strokes end there."""
        control, stroke = self.control, np.repeat(np.arange(len(self.source)), np.diff(self.offsets))
        key = np.arange(len(control), dtype=np.float64)[:, None]
        while True:
            low, high = control.min(axis=1), control.max(axis=1)
            away = norm(np.maximum(np.maximum(low - place, place - high), 0.0))
            near = away < radius
            cut = near & (norm(high - low) > 0.5 * radius)
            if not cut.any():
                break
            before, after = split(control[cut], 0.5)
            control = np.concatenate([control[~cut], before, after])
            stroke = np.concatenate([stroke[~cut], stroke[cut], stroke[cut]])
            digits = [np.zeros((int((~cut).sum()), 1)), np.zeros((int(cut.sum()), 1)), np.ones((int(cut.sum()), 1))]
            key = np.column_stack([np.concatenate([key[~cut], key[cut], key[cut]]), np.concatenate(digits)])
        if not near.any():
            return self
        order = np.lexsort(key.T[::-1])
        control, stroke, near = control[order], stroke[order], near[order]
        hit = np.zeros(len(self.source), dtype=np.bool_)
        hit[stroke[near]] = True
        begins = np.concatenate([[True], (np.diff(stroke) > 0) | near[:-1]])
        part = np.cumsum(begins) - 1
        control, stroke, part = control[~near], stroke[~near], part[~near]
        _, first = np.unique(part, return_index=True)
        own = stroke[first]
        return Curves(
            control,
            np.append(first, len(part)).astype(np.intp),
            self.source[own],
            self.closed[own] & ~hit[own],
            self.smooth[own],
        )


def on_paper(curves: Curves, strokes: Paths, setting: Setting, tolerance_mm: float) -> tuple[Paths, bool]:
    """The strokes of a drawing as they are on the paper, their chords within a tolerance, and whether there were points
    enough for that."""
    many = len(curves.source)
    if not many:
        return Paths.empty(), True
    # Stroke i runs over the parameters offsets[i] + i to offsets[i+1] + i; the last curve of each is its last point.
    count = np.diff(curves.offsets)
    place = np.arange(len(curves.control)) + ragged.owner(count)
    ends = curves.offsets[1:] + np.arange(many)
    control = np.empty((len(curves.control) + many, 4, 2))
    control[place], control[ends] = curves.control, curves.control[curves.offsets[1:] - 1, 3][:, None]

    def drawn(t: Floats) -> Floats:
        at = np.floor(t[:, 0]).astype(np.intp)
        return bezier_points(control[at], t[:, 0] - at)

    last = np.zeros(len(control), dtype=np.bool_)
    last[ends] = True
    traces = Traces(np.arange(len(control), dtype=np.float64)[:, None], last)
    found = refined(traces, straight_between, lambda t: setting.on_paper(drawn(t)), tolerance_mm, MOST_POINTS)
    may_stop()
    t, sizes = found.lines.points, np.diff(found.lines.ends, prepend=-1)
    points = setting.on_paper(drawn(t))
    line = ragged.owner(sizes)
    at = np.floor(t[:, 0]).astype(np.intp)
    node, final, initial = t[:, 0] == at, found.lines.last, np.zeros(len(t), dtype=np.bool_)
    initial[found.lines.starts] = True
    behind, ahead = np.where(node & ~initial, at - 1, at), np.where(final, at - 1, at)
    ways = []
    for curve in (behind, ahead):
        slope = setting.slopes(drawn(t), bezier_tangents(control[curve], t[:, 0] - curve))
        # Where a curve stands still nothing is known of its direction.
        ways.append(np.where((slope != 0.0).any(axis=1), arctan2(slope[:, 1], slope[:, 0]), np.nan))
    loops = np.flatnonzero(curves.closed)
    ways[0][found.lines.starts[loops]] = ways[0][found.lines.ends[loops]]
    kept, offsets = found.lines.unrepeated(curves.closed)
    points, directions = points[kept], np.column_stack(ways)[kept]
    source = curves.source
    paths = Paths(
        points,
        offsets,
        curves.closed,
        strokes.kind[source],
        strokes.item[source],
        strokes.hidden_by[source],
        np.column_stack([points, np.zeros(len(points))]),
        curves.smooth | (np.bincount(line, minlength=many) > count + 1),
        directions,
        strokes.curve[source],
        lamp=strokes.lamp[source],
    )
    return paths, bool(found.enough.all())


def _laid(drawing: Drawing, setting: Setting, tolerance_mm: float, curved: bool) -> tuple[list[Layer], bool]:
    """The layers of a drawing on the paper, and whether there were points enough."""
    layers, enough = [], True
    for layer in drawing.layers:
        marks: list[Paths | CurvedStrokes | Fills] = []
        for mark in _bent(layer, setting.mirror):
            if isinstance(mark, Fills):
                bent, plenty = fills_on_paper(mark, setting, tolerance_mm)
                marks.append(bent)
            else:
                strokes = one_mark((mark,))
                curves = Curves.of(strokes)
                if setting.mirror.kind == "cone":
                    curves = curves.without(_tip(setting), tolerance_mm / setting.scale)
                paths, plenty = on_paper(curves, strokes.paths, setting, CHORD_SHARE * tolerance_mm)
                marks.append(curved_strokes(paths, tolerance_mm) if curved else paths)
            enough &= plenty
        layers.append(replace(layer, marks=tuple(marks)))
    return layers, enough


def _bent(layer: Layer, mirror: CurvedMirror | None) -> list[Paths | CurvedStrokes | Fills]:
    """The marks of a layer that a mirror shows: strokes, and, but for the paper, filled polygons; these not in a cone,
    where one with the tip in it would be all around."""
    filled = layer.plotted and (mirror is None or mirror.kind != "cone")
    return [mark for mark in layer.marks if isinstance(mark, STROKES) or (filled and isinstance(mark, Fills))]


def fills_on_paper(fills: Fills, setting: Setting, tolerance_mm: float) -> tuple[Fills, bool]:
    """Filled polygons as they are on the paper, each in the mean of the colours of its corners, and whether there were
    points enough."""
    size = np.diff(fills.offsets)
    none = np.zeros(len(fills), dtype=np.intp)
    sides = Paths(fills.points, fills.offsets, size > 2, none, none, none, fills.points3d)
    paths, plenty = on_paper(Curves.of(one_mark((sides,))), sides, setting, tolerance_mm)
    # Those of one corner are gone.
    source = np.flatnonzero(size > 1)
    count = np.diff(paths.offsets)
    # A line goes on as several lines.
    parts, each = np.where(paths.closed, 1, count - 1), np.where(paths.closed, count, 2)
    of = ragged.owner(parts)
    corner = ragged.ranges(paths.offsets[of] + ragged.place(parts), each[of])
    mean = np.add.reduceat(fills.colours.astype(np.float64), fills.offsets[source]) / size[source, None]
    own = source[of]
    points = paths.points[corner]
    return Fills.flat(
        points,
        ragged.offsets(each[of]),
        np.rint(mean).astype(np.uint8)[of],
        opacity=fills.opacity[own],
        item=fills.item[own],
        kind=fills.kind[own],
    ), plenty


def _tip(setting: Setting) -> Floats:
    """(2,) the point of the drawing that is seen at the tip of a cone."""
    way = np.array([0.0, 0.0, setting.mirror.height]) - setting.eye
    sight = setting.centre - setting.eye
    off = float(dot(sight, sight)) / float(dot(way, sight)) * way - sight
    return setting.middle + np.array([float(dot(off, setting.right)), float(dot(off, setting.up))]) / setting.scale


# Where the mirror stands and the eye is.


@dataclass(frozen=True, eq=False)
class Marks:
    """What one needs to lay the drawing down: strokes of the mirror and of the eye, and a text."""

    mirror: Paths
    viewer: Paths
    notes: Paths


def _polylines(lines: Sequence[Floats]) -> Paths:
    return Paths.of_polylines(lines, kind=LineKind.LABEL, item=NO_ITEM)


def _cross(place: Floats) -> list[Floats]:
    half = 0.5 * CROSS_MM
    return [place + np.array([(-half, 0.0), (half, 0.0)]), place + np.array([(0.0, -half), (0.0, half)])]


def _arrow(foot: Floats, towards: Floats) -> list[Floats]:
    tip, side = foot + ARROW_MM * towards, 0.2 * ARROW_MM * np.array([-towards[1], towards[0]])
    back = tip - 0.4 * ARROW_MM * towards
    return [np.stack([foot, tip]), np.stack([back + side, tip, back - side])]


def _marks(setting: Setting, points: Floats, highest: float) -> Marks:
    """The marks beside points (n,2) of a drawing on the paper, which is seen up to some height of the mirror."""
    mirror, eye, axis = setting.mirror, setting.eye, np.zeros(2)
    level, away = eye[:2], float(norm(eye[:2]))
    foot = []
    if mirror.kind != "none":
        turn = 2.0 * np.pi * np.arange(FOOT_POINTS) / FOOT_POINTS
        foot = [mirror.radius * np.column_stack([np.cos(turn), np.sin(turn)])]
        points = np.concatenate([points, foot[0]])
        foot += _cross(axis)
    found = Paths.of_polylines(foot, closed=[k == 0 for k in range(len(foot))], kind=LineKind.LABEL, item=NO_ITEM)
    found = replace(found, smooth=found.closed.copy())
    pointer = []
    if away > COINCIDENT_MM:
        towards = level / away
        begin = float(dot(points, towards).max()) + GAP_MM
        pointer = _cross(level)
        if away > begin + ARROW_MM:
            pointer = _arrow(begin * towards, towards)
            if mirror.kind == "none":
                # The middle of the picture stays clear.
                pointer += _cross(begin * towards)
                away -= begin
    viewer = _polylines(pointer)
    every = np.concatenate([points, viewer.points])
    at = (float(every[:, 0].min()), float(every[:, 1].min()) - GAP_MM)
    letters = lettered(_words(mirror, eye, away, highest), at, size_mm=LETTERS_MM, level="top").strokes
    return Marks(found, viewer, _polylines([letters[k] for k in range(len(letters))]))


def _words(mirror: CurvedMirror, eye: Floats, away: float, highest: float) -> str:
    """What kind of mirror, and where the eye is."""
    beside = f", {away:.4g} mm from the {'cross' if mirror.kind == 'none' else 'axis'}" if away > COINCIDENT_MM else ""
    seen = f"eye: {eye[2]:.4g} mm above the paper{beside}"
    if mirror.kind == "none":
        return seen
    rim = f"{mirror.height:.4g} mm high" if np.isfinite(mirror.height) else f"{np.ceil(highest):.4g} mm high or higher"
    return f"mirror: {mirror.kind}, radius {mirror.radius:.4g} mm, {rim}\n{seen}"


# The verb.


@stoppable
def anamorphosis(
    picture: object,
    camera: Camera | None = None,
    *,
    mirror: AnamorphicMirror | str = "cylinder",
    page: Page | str | None = None,
    curves: str = "bezier",
    tolerance_mm: float = 0.02,
    budget: float = 1.0,
    jobs: int | None = None,
    progress: Callable[[str, float], None] | None = None,
    explain: Callable[[StageReport], None] | None = None,
) -> Drawing:
    """A drawing in true size to lay around a curved mirror, in which the picture is seen undistorted.

    Parameters
    ----------
    picture : Drawing, Scene, path, Item, Mesh, surface, curve, or several of these
        What is to be seen: the strokes and filled polygons of a drawing, such as `draw`, `paint` or `read` returns; all
        else is drawn first, see `draw`.
    camera : Camera, optional
        How a scene is drawn.
    mirror : AnamorphicMirror or {"cylinder", "cone", "none"}
        What the drawing is laid around, and from where one looks into it; or what kind of mirror that is.
    page : Page or str, optional
        Or its name or size; where None a page as large as the drawing, with a margin.
    curves : {"bezier", "polyline", "arcs"}
        How curves leave; arcs are Bézier curves here.
    tolerance_mm : float
        How far strokes may be off on the paper.
    budget : float
        As in draw, of which it is one.
    jobs : int, optional
        As in draw.
    progress, explain : callable, optional
        As in draw.

    Returns
    -------
    Drawing
        The layers of the picture with their pens; then mirror, the circle that it stands in and its middle; viewer, an
        arrow to the eye, or a cross below it; and notes, what kind of mirror it is and where the eye has to be.

    Raises
    ------
    InputError
        See `draw`.
        For a picture without strokes and polygons, or larger than the mirror shows, with how large it may be; for a
        drawing that does not fit the page.

    Warns
    -----
    InputWarning
        For texts, and in cones filled polygons, which are left out.

    Notes
    -----
    The picture seems to stand across the line of sight from the eye to the axis of the mirror. The way from the eye to
    each of its points meets the mirror, is reflected there and ends on the paper; all of that is in closed form. Lines
    become curves: they are divided until they are within the tolerance. Near the tip of a cone the paper shows
    everything enlarged without end: what is nearer to it than the tolerance is left out, and strokes end there.

    Source: Niceron, La perspective curieuse (1638); Hunt, Nickel, Gigault, Anamorphic images, American Journal of
    Physics 68 (2000).

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> laid = vp.anamorphosis(geometry.box((2, 2, 2)), mirror=vp.AnamorphicMirror(radius_mm=20))
    >>> [layer.name for layer in laid.layers if len(layer.strokes[0])]
    ['visible', 'contour', 'mirror', 'viewer', 'notes']
    """
    check_options(locals())
    drawn = picture_of(picture, camera, curves=curves, budget=budget, jobs=jobs, explain=explain)
    glass = AnamorphicMirror(mirror) if isinstance(mirror, str) else mirror
    work: dict[str, Any] = {"jobs": jobs, "progress": progress, "explain": explain}
    return anamorphosis_of(drawn, on_page, glass, page=page, curves=curves, tolerance_mm=tolerance_mm, **work)


@stoppable
def anamorphosis_view(
    picture: object,
    camera: Camera | None = None,
    *,
    mirror: AnamorphicMirror | str = "cylinder",
    page: Page | str | None = None,
    curves: str = "bezier",
    tolerance_mm: float = 0.02,
    budget: float = 1.0,
    jobs: int | None = None,
    progress: Callable[[str, float], None] | None = None,
    explain: Callable[[StageReport], None] | None = None,
) -> Drawing:
    """What is seen of an anamorphosis from where its viewer is: the mirror, the picture in it, and the paper around it.

    Parameters
    ----------
    picture : Drawing, Scene, path, Item, Mesh, surface, curve, or several of these
        See `anamorphosis`.
    camera : Camera, optional
        See `anamorphosis`.
    mirror, page, curves, tolerance_mm, budget, jobs, progress, explain : see anamorphosis
        The picture in the mirror has the size that it seems to have there.

    Returns
    -------
    Drawing
        The layers of the paper, as far as the mirror does not hide it, with the word paper before their names; those of
        the picture; and mirror, its outline.

    Raises
    ------
    InputError
        See `anamorphosis`.

    Notes
    -----
    Edge cases: the paper is shown as far as 45 degrees to each side of the line of sight; without a mirror the paper
    looks like the picture, which is all there is.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> seen = vp.anamorphosis_view(geometry.box((2, 2, 2)), mirror=vp.AnamorphicMirror(radius_mm=20))
    >>> [layer.name for layer in seen.layers if len(layer.strokes[0])]
    ['paper visible', 'paper contour', 'visible', 'contour', 'mirror']
    """
    check_options(locals())
    drawn = picture_of(picture, camera, curves=curves, budget=budget, jobs=jobs, explain=explain)
    glass = AnamorphicMirror(mirror) if isinstance(mirror, str) else mirror
    work: dict[str, Any] = {"jobs": jobs, "progress": progress, "explain": explain}
    return anamorphosis_of(drawn, as_seen, glass, page=page, curves=curves, tolerance_mm=tolerance_mm, **work)


Progress = Callable[[str, float], None]

Drawn = Callable[[Page, float, Progress | None], Drawing]
"""Draws what is to be seen on a page, with a tolerance in mm, and says how far it has come."""


def picture_of(picture: object, camera: Camera | None, **how: Any) -> Drawn:
    """What draws a picture, with more keywords of draw; a drawing is as it is."""
    if isinstance(picture, Drawing):
        return partial(_as_it_is, picture)
    return partial(_drawn, partial(draw, scene_of(picture), camera, **how))


def _as_it_is(drawing: Drawing, page: Page, tolerance_mm: float, progress: Progress | None) -> Drawing:
    return drawing


def _drawn(verb: Callable[..., Drawing], page: Page, tolerance_mm: float, progress: Progress | None) -> Drawing:
    return verb(page=page, tolerance_mm=tolerance_mm, progress=progress)


Laid = Callable[[Drawing, Setting, Page | str | None, float, bool], Drawing]
"""Makes a page of a drawing that is looked at, within a tolerance in mm, with curves or without."""


def anamorphosis_of(
    drawn: Drawn,
    laid: Laid,
    mirror: AnamorphicMirror,
    *,
    page: Page | str | None,
    curves: str,
    tolerance_mm: float,
    jobs: int | None,
    progress: Progress | None,
    explain: Callable[[StageReport], None] | None,
) -> Drawing:
    """What is laid on a page of the anamorphosis of what is drawn for it; all else as in `anamorphosis`."""
    stages = [Stage("picture", "what is to be seen"), Stage("paper", f"mirror: {mirror.kind}")]
    pipeline = Pipeline(stages, explain, progress, threads_of(jobs))
    done = pipeline.fraction("picture")
    inner = None if progress is None else lambda _, part: done(part)
    shown, setting = pipeline.run("picture", _shown, drawn, mirror, tolerance_mm, inner)
    how = (page, (1.0 - OF_DRAWING) * tolerance_mm, curves != "polyline")
    return pipeline.run("paper", laid, shown, setting, *how)


def _shown(
    drawn: Drawn, looking: AnamorphicMirror, tolerance_mm: float, progress: Progress | None
) -> tuple[Drawing, Setting]:
    """The drawing, as fine as the paper enlarges it, and how it is looked at."""
    mirror, eye, seen_mm = looking.curved, looking.eye, looking.seen_mm
    side = seen_mm or 2.0 * (OF_DISTANCE * float(norm(eye)) if mirror.kind == "none" else mirror.radius)
    enlarged = ENLARGED
    while True:
        finer = max(OF_DRAWING * tolerance_mm / enlarged, LEAST_TOLERANCE_MM)
        drawing = drawn(Page(side, side, 0.0), finer, progress)
        points = _outline(drawing, mirror)
        setting = _fitted(mirror, eye, points, seen_mm)
        needed = min(setting.enlargement(points[:: 1 + len(points) // SAMPLES]), MOST_ENLARGED)
        if not needed > enlarged:
            break
        # A finer drawing may reach a little farther.
        enlarged = min(LARGER * needed, MOST_ENLARGED)
    left_out = sum(
        len(mark)
        for layer in drawing.layers
        if layer.plotted
        for mark in layer.marks
        if mark not in _bent(layer, mirror)
    )
    if left_out:
        what = "filled polygons and texts" if mirror.kind == "cone" else "texts"
        warnings.warn(f"anamorphosis: {left_out} {what} are left out: they cannot be bent", InputWarning, stacklevel=2)
    return drawing, setting


def _outline(drawing: Drawing, mirror: CurvedMirror) -> Floats:
    """(k,2) points of all that a mirror shows of a drawing. Errors: InputError where that is nothing."""
    marks = [mark for layer in drawing.layers for mark in _bent(layer, mirror)]
    every = np.concatenate([np.zeros((0, 2)), *map(_points, marks)])
    if not len(every):
        raise InputError("anamorphosis: the picture has no strokes: there is nothing to be seen in the mirror")
    return every


def _points(mark: Paths | CurvedStrokes | Fills) -> Floats:
    return mark.paths.points if isinstance(mark, CurvedStrokes) else mark.points


def _points_of(layers: Sequence[Layer]) -> Floats:
    """(n,2) points of all strokes and filled polygons."""
    return np.concatenate([np.zeros((0, 2)), *(_points(mark) for layer in layers for mark in _bent(layer, None))])


def on_page(drawing: Drawing, setting: Setting, page: Page | str | None, tolerance_mm: float, curved: bool) -> Drawing:
    """The drawing on the paper, with its marks, on a page."""
    layers, enough = _laid(drawing, setting, tolerance_mm, curved)
    if not enough:
        text = f"anamorphosis: more than {MOST_POINTS:.0f} points: some strokes may be off by more than asked for"
        warnings.warn(text, InputWarning, stacklevel=2)
    points = _points_of(layers)
    if not np.isfinite(points).all():
        raise InputError("anamorphosis: parts of the picture are not seen in the mirror: make it smaller")
    highest = 0.0 if setting.mirror.kind == "none" else float(setting.heights(_outline(drawing, setting.mirror)).max())
    marks = _marks(setting, points, highest)
    foot = curved_strokes(marks.mirror, tolerance_mm) if curved else marks.mirror
    signs = {"mirror": foot, "viewer": marks.viewer, "notes": marks.notes}
    layers += [Layer(name, MARK_PEN, (mark,)) for name, mark in signs.items()]
    every = np.concatenate([points, marks.mirror.points, marks.viewer.points, marks.notes.points])
    return _paged(drawing, layers, every, page)


def _paged(drawing: Drawing, layers: Sequence[Layer], points: Floats, page: Page | str | None) -> Drawing:
    """The layers of a drawing, which reach as far as points (n,2), in the middle of a page, or of one as large as they
    need. Errors: InputError where they do not fit."""
    low, size = points.min(axis=0), np.ptp(points, axis=0)
    asked = page_of("fit" if page is None else page, Scene(()))
    if isinstance(asked, PageAtScale):
        raise InputError("page: an anamorphosis is in true size, at no scale")
    sheet = asked.around(*size.tolist())
    room = np.array(sheet.room)
    if (size > room + COINCIDENT_MM).any():
        (wide, high), (w, h) = size.tolist(), room.tolist()
        raise InputError(f"the anamorphosis takes {wide:.0f} x {high:.0f} mm, the page has {w:.0f} x {h:.0f} mm for it")
    shift = sheet.margin_mm + 0.5 * (room - size) - low
    world = np.eye(4)
    world[:2, 3] = shift
    moved = tuple(replace(layer, marks=tuple(moved_mark(mark, 1.0, shift) for mark in layer.marks)) for layer in layers)
    return Drawing(sheet.width_mm, sheet.height_mm, moved, drawing.items, drawing.title, world)


# What one sees then.


def as_seen(drawing: Drawing, setting: Setting, page: Page | str | None, tolerance_mm: float, curved: bool) -> Drawing:
    """The drawing as it seems to stand in the mirror, the mirror, and the paper before and beside it, from the eye."""
    mirror = setting.mirror
    by = -setting.scale * setting.middle
    layers = [
        replace(layer, marks=tuple(moved_mark(mark, setting.scale, by) for mark in _bent(layer, mirror)))
        for layer in drawing.layers
    ]
    if mirror.kind != "none":
        highest = float(setting.heights(_outline(drawing, setting.mirror)).max())
        rim = mirror.height if np.isfinite(mirror.height) else highest + ABOVE_FOOT * mirror.radius
        body, lines = _body_seen(setting, rim)
        laid, _ = _laid(drawing, setting, tolerance_mm, False)
        paper = []
        for layer in laid:
            marks = [_beside(mark, setting, body, tolerance_mm if curved else None) for mark in layer.marks]
            if any(map(len, marks)):
                paper.append(replace(layer, name=f"paper {layer.name}", marks=tuple(marks)))
        if any(layer.fills for layer in paper):
            # The mirror covers what is filled behind it.
            paper.append(Layer("body", MARK_PEN, (_blank(body),)))
        layers = [*paper, *layers, Layer("mirror", MARK_PEN, (lines,))]
    return _paged(drawing, layers, _points_of(layers), page)


def _seen_from(setting: Setting, places: Floats) -> Floats:
    """(k,2) where places (k,3) are seen in the plane in which the picture seems to stand."""
    ways, sight = places - setting.eye, setting.centre - setting.eye
    with np.errstate(all="ignore"):
        far = float(dot(sight, sight)) / dot(ways, sight)
        off = np.where(far > 0.0, far, np.nan)[:, None] * ways - sight
    return np.column_stack([dot(off, setting.right), dot(off, setting.up)])


def _half_field(setting: Setting) -> float:
    """Half the side of the square in which things are shown as seen."""
    return FIELD * float(norm(setting.centre - setting.eye))


def _beside(mark: Any, setting: Setting, body: Any, curved_mm: float | None) -> Any:
    """A mark on the paper as it is seen: polygons that are in the field, strokes as far as they are, outside a polygon
    of shapely that hides them, as curves within curved_mm unless that is None."""
    if isinstance(mark, Fills):
        seen = replace(mark, points=_seen_from(setting, mark.points3d))
        shown = (np.abs(seen.points) <= _half_field(setting)).all(axis=1)
        return take(seen, np.logical_and.reduceat(shown, seen.offsets[:-1])) if len(seen) else seen
    left = _outside(mark, setting, body)
    return left if curved_mm is None else curved_strokes(left, curved_mm)


def _blank(body: Any) -> Fills:
    """A polygon of shapely in white."""
    import shapely

    corners = shapely.get_coordinates(body)[:-1]
    white = np.full((1, 3), 255, dtype=np.uint8)
    return Fills.flat(corners, np.array([0, len(corners)]), white, kind=FillKind.BACKGROUND)


def _body_seen(setting: Setting, rim: float) -> tuple[Any, Paths]:
    """The polygon (of shapely) that the mirror covers as it is seen, and its outline and upper rim as strokes."""
    import shapely

    turn = 2.0 * np.pi * np.arange(FINE_POINTS + 1) / FINE_POINTS
    ring = setting.mirror.radius * np.column_stack([np.cos(turn), np.sin(turn)])
    ring[-1] = ring[0]
    foot = _seen_from(setting, np.column_stack([ring, np.zeros(len(ring))]))
    upper = ring if setting.mirror.kind == "cylinder" else np.zeros((1, 2))
    top = _seen_from(setting, np.column_stack([upper, np.full(len(upper), rim)]))
    every = np.concatenate([foot, top])
    body = shapely.convex_hull(shapely.multipoints(every[np.isfinite(every).all(axis=1)]))
    lines = shapely.get_exterior_ring(body)
    if len(top) > 1 and setting.eye[2] > rim:
        lines = shapely.line_merge(shapely.union(shapely.linestrings(lines.coords), shapely.linestrings(top)))
    half = _half_field(setting)
    lines = shapely.line_merge(shapely.intersection(lines, shapely.box(-half, -half, half, half)))
    parts = [shapely.get_coordinates(part) for part in shapely.get_parts(lines)]
    found = _polylines(parts)
    return body, replace(found, smooth=np.ones(len(found), dtype=np.bool_))


def _outside(paths: Paths, setting: Setting, body: Any) -> Paths:
    """What strokes on the paper look like in the field, outside a polygon of shapely."""
    import shapely

    if not len(paths):
        return paths
    half = _half_field(setting)
    rounds = closed_round(paths)
    rings = shapely.linestrings(paths.points[rounds.index], indices=ragged.owner(np.diff(rounds.offsets)))
    ahead = shapely.intersection(rings, _ahead(setting, float(np.abs(paths.points).max())))
    rings = shapely.transform(ahead, lambda at: _seen_from(setting, np.column_stack([at, np.zeros(len(at))])))
    left = shapely.difference(shapely.intersection(rings, shapely.box(-half, -half, half, half)), body)
    parts, source = shapely.get_parts(shapely.line_merge(left), return_index=True)
    points, part = shapely.get_coordinates(parts, return_index=True)
    sizes = np.bincount(part, minlength=len(parts))
    kept = sizes > 1
    points, source, offsets = points[np.repeat(kept, sizes)], source[kept], ragged.offsets(sizes[kept])
    nowhere = np.column_stack([points, np.zeros(len(points))])
    rest = (paths.kind[source], paths.item[source], paths.hidden_by[source], nowhere, paths.smooth[source])
    return Paths(points, offsets, np.zeros(len(source), dtype=np.bool_), *rest)


def _ahead(setting: Setting, reach: float) -> Any:
    """The paper in front of the eye, with all of it in the field, as far as a reach: a polygon of shapely."""
    import shapely

    sight = setting.centre - setting.eye
    level = float(norm(sight[:2]))
    square = np.array([(0.0, -1.0), (2.0, -1.0), (2.0, 1.0), (0.0, 1.0)])
    if level <= NO_AZIMUTH_SINE * float(norm(sight)):
        # All of it is as far away.
        return shapely.polygons(2.0 * reach * (square - (1.0, 0.0)))
    along = sight[:2] / level
    # Of a ray in the field, no longer than its parts together, so much is along the line of sight.
    least = float(setting.eye[2] * norm(sight)) / (1.0 + 2.0 * FIELD)
    begin = (least + float(dot(setting.eye, sight))) / level
    size = 2.0 * (reach + abs(begin))
    corners = np.outer(begin + size * square[:, 0], along)
    return shapely.polygons(corners + np.outer(size * square[:, 1], (-along[1], along[0])))
