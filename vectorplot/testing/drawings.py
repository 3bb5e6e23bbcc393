"""Whether two drawings show the same lines, and whether a drawing shows what can be seen, checked by rays."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Drawing, Paths
from vectorplot.drawing.strokes import chosen
from vectorplot.features.conditions import CentralContour, Isophote
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.vectors import dot, norm
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.surface import ImplicitSurface, Surface, hessians, is_implicit, is_parametrised
from vectorplot.testing.rays import inside, nearest_places, visible_by_rays
from vectorplot.testing.sight_rays import edges_of_faces
from vectorplot.tolerances import CLEARANCE_OF_EXTENT, COVERED_OF_TOLERANCE
from vectorplot.words import LineKind

# Whether two drawings show the same lines, however these are cut into strokes.

Group = tuple[int, bool]


def assert_drawings_equal(a: Drawing, b: Drawing, tolerance_mm: float = 0.01) -> None:
    """Nothing, where two drawings show the same lines; otherwise an AssertionError that names the worst point.

    Parameters
    ----------
    a, b : Drawing
        On pages of one size.
    tolerance_mm : float
        In mm on the page.

    Raises
    ------
    AssertionError
        With the kind of line, the point and its distance from the nearest such line.

    Notes
    -----
    For each kind of line, visible and hidden apart, every point of a line in one drawing must lie within tolerance_mm
    of such a line in the other. The order, direction and splitting of the strokes, layers and pens do not matter; nor
    does it matter whether a line is stroked once or twice.

    Edge cases: strokes of no length count as points.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> cube = vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),))
    >>> by_kind = vp.draw(cube, layers="kind")
    >>> testing.assert_drawings_equal(by_kind, vp.draw(cube, layers="colour"))
    """
    sizes = [(drawing.width_mm, drawing.height_mm) for drawing in (a, b)]
    assert np.allclose(sizes[0], sizes[1], rtol=0.0, atol=tolerance_mm), (
        f"the first page is {sizes[0][0]:g} x {sizes[0][1]:g} mm, the second {sizes[1][0]:g} x {sizes[1][1]:g} mm"
    )
    first, second = lines_by_group(a), lines_by_group(b)
    nothing = np.zeros((0, 2, 2))
    faults: list[tuple[float, str]] = []
    for group in sorted({*first, *second}):
        here, there = first.get(group, nothing), second.get(group, nothing)
        for lines, others, names in ((here, there, ("first", "second")), (there, here, ("second", "first"))):
            found = worst_uncovered(lines, others, tolerance_mm)
            if found is not None:
                point, distance = found
                faults.append((distance, fault_text(group, names, point, distance, tolerance_mm)))
    assert not faults, max(faults)[1] + (f"; {len(faults) - 1} more differences" if len(faults) > 1 else "")


def fault_text(group: Group, names: tuple[str, str], point: Floats, distance: float, tolerance_mm: float) -> str:
    """One line on where a line of one drawing is missing in the other."""
    what = f"{'hidden' if group[1] else 'visible'} {LineKind(group[0]).word}"
    near = f"the nearest is {distance:.4g} mm away" if np.isfinite(distance) else "it has none at all"
    return (
        f"{what}: at ({point[0]:.4f}, {point[1]:.4f}) mm the {names[0]} drawing has a line, "
        f"the {names[1]} has none within {tolerance_mm:g} mm ({near})"
    )


def lines_by_group(drawing: Drawing) -> dict[Group, Floats]:
    """The segments (n,2,2) of a drawing in mm for each kind, visible and hidden apart."""
    groups: dict[Group, list[Floats]] = {}
    for layer in drawing.layers:
        for paths in layer.strokes:
            start, end, path = path_segments(paths.offsets, paths.closed)
            lines = np.stack([paths.points[start], paths.points[end]], axis=1)
            kind, hidden = paths.kind[path], paths.hidden_by[path] > 0
            for group in {*zip(kind.tolist(), hidden.tolist(), strict=True)}:
                groups.setdefault(group, []).append(lines[(kind == group[0]) & (hidden == group[1])])
    return {group: np.concatenate(parts) for group, parts in groups.items()}


def path_segments(offsets: Ints, closed: Bools) -> tuple[Ints, Ints, Ints]:
    """Indices of both ends of every segment of some paths, and of its path; a path of one point is a segment too."""
    count = np.diff(offsets)
    path = ragged.owner(count)
    start = np.arange(len(path))
    last = start == offsets[1:][path] - 1
    end = np.where(last, offsets[:-1][path], start + 1)
    kept = ~last | closed[path] | (count == 1)[path]
    return start[kept], end[kept], path[kept]


def worst_uncovered(lines: Floats, others: Floats, tolerance: float) -> tuple[Floats, float] | None:
    """The point of some segments that is furthest from all the others, and how far; None within the tolerance."""
    if len(lines) == 0:
        return None
    if len(others) == 0:
        return lines[0].mean(axis=0), float("inf")
    from shapely import STRtree, linestrings, points

    tree = STRtree(linestrings(others))
    index, other = tree.query(linestrings(lines), predicate="dwithin", distance=tolerance)
    low, high = covered(lines[index], others[other], tolerance)
    where, owner = gaps(index, low, high, len(lines))
    length = norm(lines[:, 1] - lines[:, 0])
    ends = where * length[owner][:, None]
    real = (ends[:, 1] - ends[:, 0] > COVERED_OF_TOLERANCE * tolerance) | (length[owner] == 0.0)
    where, owner = where[real], owner[real]
    if len(owner) == 0:
        return None
    start, way = lines[owner, 0], lines[owner, 1] - lines[owner, 0]
    candidates = np.concatenate(
        [start + share[:, None] * way for share in (where[:, 0], where.mean(axis=1), where[:, 1])]
    )
    _, distance = tree.query_nearest(points(candidates), return_distance=True, all_matches=False)
    worst = int(np.argmax(distance))
    # A segment of no length has no inside that could be covered: its place alone decides.
    return (candidates[worst], float(distance[worst])) if distance[worst] > tolerance else None


def covered(lines: Floats, others: Floats, tolerance: float) -> tuple[Floats, Floats]:
    """The parameters between which each segment is within the tolerance of its partner (low > high: never).

    What is within a distance of a segment is convex, two discs and a rectangle: the hull of three intervals.
    """
    start, way = lines[:, 0], lines[:, 1] - lines[:, 0]
    low, high = np.full(len(lines), np.inf), np.full(len(lines), -np.inf)
    for centre in (others[:, 0], others[:, 1]):
        near, far = within_disc(start - centre, way, tolerance)
        low, high = (
            np.where(near <= far, np.minimum(low, near), low),
            np.where(near <= far, np.maximum(high, far), high),
        )
    axis = others[:, 1] - others[:, 0]
    length = norm(axis)
    unit = axis / np.where(length > 0.0, length, 1.0)[:, None]
    across = np.stack([-unit[:, 1], unit[:, 0]], axis=1)
    arm = start - others[:, 0]
    near, far = within_strip(dot(arm, unit), dot(way, unit), np.zeros(len(length)), length)
    left, right = within_strip(dot(arm, across), dot(way, across), np.full(len(length), -tolerance), tolerance)
    near, far = np.maximum(near, left), np.minimum(far, right)
    box = (near <= far) & (length > 0.0)
    low, high = np.where(box, np.minimum(low, near), low), np.where(box, np.maximum(high, far), high)
    return np.clip(low, 0.0, None), np.clip(high, None, 1.0)


def within_disc(arm: Floats, way: Floats, radius: float) -> tuple[Floats, Floats]:
    """Parameters t between which arm + t way is no longer than the radius; (inf, -inf) if never."""
    square, middle, rest = dot(way, way), dot(arm, way), dot(arm, arm) - radius**2
    moving = square > 0.0
    safe = np.where(moving, square, 1.0)
    root = middle**2 - square * rest
    half = np.sqrt(np.maximum(root, 0.0)) / safe
    hit = np.where(moving, root >= 0.0, rest <= 0.0)
    near = np.where(moving, -middle / safe - half, -np.inf)
    far = np.where(moving, -middle / safe + half, np.inf)
    return np.where(hit, near, np.inf), np.where(hit, far, -np.inf)


def within_strip(value: Floats, slope: Floats, low: Floats, high: Floats | float) -> tuple[Floats, Floats]:
    """Parameters t between which value + t slope lies from low to high; (inf, -inf) if never."""
    moving = slope != 0.0
    safe = np.where(moving, slope, 1.0)
    first, second = (low - value) / safe, (high - value) / safe
    hit = moving | ((value >= low) & (value <= high))
    near = np.where(moving, np.minimum(first, second), -np.inf)
    far = np.where(moving, np.maximum(first, second), np.inf)
    return np.where(hit, near, np.inf), np.where(hit, far, -np.inf)


def gaps(owner: Ints, low: Floats, high: Floats, count: int) -> tuple[Floats, Ints]:
    """What intervals leave open of [0, 1]: (g,2) parameters and (g,) the owner, for owners 0 to count."""
    used = low <= high
    owner, low, high = owner[used], low[used], high[used]
    order = np.lexsort((low, owner))
    owner, low, high = owner[order], low[order], high[order]
    # The furthest end so far within each owner: shifting owner k by 2k makes one running maximum serve all.
    reach = np.maximum.accumulate(high + 2.0 * owner) - 2.0 * owner
    first = np.ones(len(owner), dtype=np.bool_)
    first[1:] = owner[1:] != owner[:-1]
    before = np.where(first, 0.0, np.concatenate([[0.0], reach[:-1]]))
    last = np.append(first[1:], True)[: len(owner)]
    untouched = np.setdiff1d(np.arange(count), owner)
    starts = np.concatenate([before, reach[last], np.zeros(len(untouched))])
    ends = np.concatenate([low, np.ones(int(last.sum())), np.ones(len(untouched))])
    owners = np.concatenate([owner, owner[last], untouched])
    left = ends > starts
    return np.stack([starts[left], ends[left]], axis=1), owners[left]


# Points on the strokes of a drawing at which rays can say whether they are drawn as they should be.

STEPS = 8

ASIDE = 10.0
"""A point found from a chord may be beside the true curve, and is compared only where the clearance is larger than so
many times the distance of the chord from it."""

ONE_SHEET = [int(kind) for kind in (LineKind.CONTOUR, LineKind.PARAMETER, LineKind.ISOPHOTE, LineKind.SECTION)]


class StrokePoints(NamedTuple):
    """points (n,3) in the world; kind, item and hidden_by (n,) of their strokes; aside (n,): how far they may be from
    the true curve, in the world."""

    points: Floats
    kind: Ints
    item: Ints
    hidden_by: Ints
    aside: Floats

    def rows(self, kept: Ints | Bools) -> StrokePoints:
        """Some of them."""
        return StrokePoints(self.points[kept], self.kind[kept], self.item[kept], self.hidden_by[kept], self.aside[kept])


def stroke_points(drawing: Drawing, scene: Scene, camera: Camera, samples: int, seed: int) -> StrokePoints:
    """Random points on the strokes, half of them by length, half with one chance for each segment.

    Of straight strokes they lie anywhere. Of smooth strokes, whose chords are beside the curve, they are inner vertices
    (at the ends visibility changes, and so it may where strokes meet), or points of chords moved to the surface, those
    of a contour to the contour.
    """
    straight = [_seen_straight(paths) for layer in drawing.layers for paths in layer.strokes]
    parts = [_segments(paths) for paths in straight if len(paths)]
    if not parts:
        return _none()
    lines, owner, smooth, deviation, at_end = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    random = np.random.default_rng(seed)
    index, share = some_of(lines, samples, random)
    if not len(index):
        return _none()
    at_end = at_end[index] | _where_strokes_meet(lines, index)
    one_sheet = _on_one_sheet(scene, owner[index])
    vertex = smooth[index] & ((random.random(samples) < 0.5) | ~one_sheet)
    ends = vertex & at_end[np.arange(len(index)), np.round(share).astype(np.intp)]
    vertex &= ~(ends & one_sheet)
    useful = ~ends | one_sheet
    share = np.where(vertex, np.round(share), share)[:, None]
    points = lines[index, 0] * (1.0 - share) + lines[index, 1] * share
    aside = np.where(smooth[index] & ~vertex, ASIDE * deviation[index], 0.0)
    kind, item, hidden_by = owner[index].T
    found = StrokePoints(points, kind, item, hidden_by, aside)
    moving = np.flatnonzero(smooth[index] & ~vertex)
    return _moved(found, moving, useful, lines[index, 1] - lines[index, 0], scene, camera)


def _seen_straight(paths: Paths) -> Paths:
    """Strokes but for those that are seen by way of mirrors, or bent: no straight rays tell of these."""
    elsewhere = np.isin(paths.kind, (LineKind.REFLECTED, LineKind.REFRACTED))
    return chosen(paths, ~elsewhere) if elsewhere.any() else paths


def _where_strokes_meet(lines: Floats, some: Ints) -> Bools:
    """(n,2) whether more than two ends of segments (m,2,3) are where an end of some of them is, (n,) their indices: as
    near as points are that are not compared."""
    from scipy.spatial import cKDTree

    ends = lines.reshape(-1, 3)
    near = CLEARANCE_OF_EXTENT * float(np.ptp(ends, axis=0).max())
    tree = cKDTree(ends, balanced_tree=False, compact_nodes=False)
    return np.asarray(tree.query_ball_point(lines[some].reshape(-1, 3), near, return_length=True).reshape(-1, 2) > 2)


def some_of(lines: Floats, samples: int, random: np.random.Generator) -> tuple[Ints, Floats]:
    """Indices and shares of random points on segments, half of them by length, half with one chance for each."""
    length = norm(lines[:, 1] - lines[:, 0])
    if not length.sum() > 0.0:
        return np.zeros(0, dtype=np.intp), np.zeros(0)
    by_length = np.searchsorted(np.cumsum(length), random.random(samples // 2) * length.sum(), side="right")
    by_number = random.integers(len(lines), size=samples - samples // 2)
    return np.concatenate([by_length.clip(max=len(lines) - 1), by_number]), random.random(samples)


def _none() -> StrokePoints:
    none = np.zeros(0, dtype=np.intp)
    return StrokePoints(np.zeros((0, 3)), none, none, none, np.zeros(0))


def _segments(paths: Paths) -> tuple[Floats, Ints, Bools, Floats, Bools]:
    """Segments (n,2,3) of strokes in the world; kind, item and hidden_by (n,3); smooth (n,); and how far from the curve
    that smooth strokes sample each can be (n,), by the angle it makes with its neighbours; and whether a stroke begins
    or ends at the segment's ends (n,2)."""

    start, end, path = path_segments(paths.offsets, paths.closed)
    lines = np.stack([paths.points3d[start], paths.points3d[end]], axis=1)
    way = lines[:, 1] - lines[:, 0]
    length = norm(way)
    unit = way / np.where(length > 0.0, length, 1.0)[:, None]
    turn = np.zeros(len(lines))
    # Segments of a path follow each other, and the first of a closed one follows the last.
    by_start = np.full(len(paths.points3d), -1)
    by_start[start] = np.arange(len(start))
    after = by_start[end]
    has = after >= 0
    angle = norm(unit[has] - unit[after[has]])
    np.maximum.at(turn, np.flatnonzero(has), angle)
    np.maximum.at(turn, after[has], angle)
    deviation = turn * length / 4.0
    smooth = paths.smooth[path]
    largest = float(deviation[smooth & (turn < 0.5)].max(initial=0.0))
    deviation = np.where(has | (turn > 0.0), deviation, largest)
    at_end = np.stack([~np.isin(start, end), ~has], axis=1)
    return lines, np.stack([paths.kind, paths.item, paths.hidden_by], axis=1)[path], smooth, deviation, at_end


def _on_one_sheet(scene: Scene, owner: Ints) -> Bools:
    """(n,) whether strokes lie on one sheet of a smooth surface, away from its borders."""
    curved = np.array([is_parametrised(item.shape) or is_implicit(item.shape) for item in scene.items], dtype=np.bool_)
    return np.asarray(np.isin(owner[:, 0], ONE_SHEET) & curved[owner[:, 1]])


def _moved(found: StrokePoints, which: Ints, useful: Bools, way: Floats, scene: Scene, camera: Camera) -> StrokePoints:
    """The useful points, some of them moved from the chord to its curve; without those that cannot be."""
    points, good = found.points.copy(), useful.copy()
    for index, item in enumerate(scene.items):
        shape = item.shape
        for contour in (False, True):
            some = which[(found.item[which] == index) & ((found.kind[which] == LineKind.CONTOUR) == contour)]
            if not len(some):
                continue
            if is_parametrised(shape):
                points[some] = _to_surface(
                    shape, points[some], way[some], camera if contour else None, found.aside[some]
                )
            elif is_implicit(shape):
                points[some] = _to_implicit(shape, points[some], way[some], camera if contour else None)
            # A point that went far did not find its curve.
            went = norm(points[some] - found.points[some])
            good[some] &= went <= found.aside[some]
    return found._replace(points=points).rows(good)


def _to_surface(surface: Surface, points: Floats, way: Floats, camera: Camera | None, near: Floats) -> Floats:
    """The nearest points of a surface; with a camera, of its contour in the plane across the way."""
    places = nearest_places(surface, points, near).first(1)
    at = np.stack([places.u[:, 0], places.v[:, 0]], axis=1)
    if camera is None:
        return surface.points(at[:, 0], at[:, 1])
    condition = Isophote(surface, camera.direction) if camera.parallel else CentralContour(surface, camera.eye)
    for _ in range(STEPS):
        u, v = at.T
        f, g = condition.values(u, v), ((surface.points(u, v) - points) * way).sum(axis=1)
        f_u, f_v = condition.slopes(u, v)
        g_u, g_v = ((by * way).sum(axis=1) for by in surface.partials(u, v))
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.stack([g * f_v - f * g_v, f * g_u - g * f_u], axis=1) / (f_u * g_v - f_v * g_u)[:, None]
        at = inside(surface.domain, at + np.nan_to_num(step, nan=0.0, posinf=0.0, neginf=0.0))
    return surface.points(at[:, 0], at[:, 1])


def _to_implicit(surface: ImplicitSurface, points: Floats, way: Floats, camera: Camera | None) -> Floats:
    """The same on an implicit surface."""
    at = points.copy()
    for _ in range(STEPS):
        value, slope = surface.values(at), surface.gradients(at)
        square = (slope * slope).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            if camera is None:
                step = -(value / square)[:, None] * slope
            else:
                step = _contour_step(surface, at, points, way, camera, value, slope)
        at = at + np.nan_to_num(step, nan=0.0, posinf=0.0, neginf=0.0)
    return at


def _contour_step(
    surface: ImplicitSurface, at: Floats, points: Floats, way: Floats, camera: Camera, value: Floats, slope: Floats
) -> Floats:
    """Newton's step (n,3) to F = 0, grad F . (eye - x) = 0, in the plane across the way."""
    ray = np.broadcast_to(camera.direction, at.shape) if camera.parallel else np.asarray(camera.eye) - at
    turned = np.einsum("nij,nj->ni", hessians(surface, at), ray) - (0.0 if camera.parallel else 1.0) * slope
    third = np.cross(slope, turned)
    volume = (third * way).sum(axis=1)[:, None]
    f, g, h = value[:, None], (slope * ray).sum(axis=1)[:, None], ((at - points) * way).sum(axis=1)[:, None]
    return np.asarray(-(f * np.cross(turned, way) + g * np.cross(way, slope) + h * third) / volume)


# Whether a drawing shows what can be seen: its strokes, and what it leaves out, against rays.


def assert_drawing_is_right(
    drawing: Drawing,
    scene: Scene,
    camera: Camera,
    *,
    samples: int = 2000,
    seed: int = 0,
    clearance: float = CLEARANCE_OF_EXTENT,
    must_show: ArrayLike | None = None,
    tolerance_mm: float = 0.01,
    margin_mm: float = 10.0,
) -> int:
    """How many points were compared, where all agree with rays; otherwise an AssertionError that names the worst fault.

    Parameters
    ----------
    drawing : Drawing
        What is checked.
    scene : Scene
        What it shows.
    camera : Camera
        How it was drawn.
    samples : int
        How many random points on the strokes are compared.
    seed : int
        Of the random numbers.
    clearance : float
        Points nearer to a transition than this part of the extent (see visible_by_rays) are left out.
    must_show : (n, 3) array_like of float, optional
        Points in the world (edge_points gives some) that must be within tolerance_mm of a visible stroke if rays find
        them visible and they lie on the page, margin_mm inside its border.
    tolerance_mm : float
        In mm on the page.
    margin_mm : float
        In mm on the page.

    Returns
    -------
    int
        Of samples and points to show, those that were not left out.

    Raises
    ------
    AssertionError
        With the number of wrong points and the worst of them, in the world.

    Notes
    -----
    Random points on the strokes must be hidden by as many items as the drawing says; on strokes of smooth curves these
    are their vertices, and points of their chords that have been moved to the surface. Strokes that are seen in
    mirrors, or bent in glass, are left out.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> cube = vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),))
    >>> camera = vp.Camera((7, 5, 4))
    >>> drawing = vp.draw(cube, camera, hidden="dashed")
    >>> testing.assert_drawing_is_right(drawing, cube, camera, samples=50) > 0
    True
    """
    found = stroke_points(drawing, scene, camera, samples, seed)
    compared = 0
    if len(found.points):
        sight = visible_by_rays(scene, camera, found.points)
        size = float(np.ptp(scene.bounds, axis=0).max()) or 1.0
        sure = sight.clearance > np.maximum(clearance, found.aside / size)
        sure &= ~sight.on_contour | (found.kind == LineKind.CONTOUR)
        wrong = np.flatnonzero(sure & (sight.hidden_by != found.hidden_by))
        compared = int(sure.sum())
        if len(wrong):
            k = wrong[np.argmax(sight.clearance[wrong])]
            what = f"a {LineKind(found.kind[k]).word} of {drawing.items[found.item[k]]}"
            raise AssertionError(
                f"{len(wrong)} of {compared} points on strokes are wrong; at {found.points[k].tolist()} {what} is "
                f"drawn as hidden by {found.hidden_by[k]} items, rays find {sight.hidden_by[k]} "
                f"(clearance {sight.clearance[k]:.2g})"
            )
    if must_show is None:
        return compared
    return compared + assert_shown(drawing, scene, camera, must_show, clearance, tolerance_mm, margin_mm)


def assert_shown(
    drawing: Drawing,
    scene: Scene,
    camera: Camera,
    must_show: ArrayLike,
    clearance: float,
    tolerance_mm: float,
    margin_mm: float,
) -> int:
    """How many of some points are visible and on the page, where all of them are on visible strokes."""
    from shapely import STRtree, linestrings
    from shapely import points as as_points

    wanted = np.asarray(must_show, dtype=np.float64).reshape(-1, 3)
    sight = visible_by_rays(scene, camera, wanted)
    place = matmul(np.c_[wanted, np.ones(len(wanted))], drawing.page_from_world.T)
    front = place[:, 3] > 0.0
    page = place[:, :2] / np.where(front, place[:, 3], 1.0)[:, None]
    border = np.array([drawing.width_mm, drawing.height_mm]) - margin_mm
    on_page = ((page >= margin_mm) & (page <= border)).all(axis=1) & front
    kept = (sight.hidden_by == 0) & (sight.clearance > clearance) & on_page
    wanted, page = wanted[kept], page[kept]
    if len(page) == 0:
        return 0
    lines = [np.zeros((0, 2, 2))]
    for layer in drawing.layers:
        for marks in layer.strokes:
            start, end, path = path_segments(marks.offsets, marks.closed)
            lines.append(np.stack([marks.points[start], marks.points[end]], axis=1)[marks.hidden_by[path] == 0])
    tree = STRtree(linestrings(np.concatenate(lines)))
    assert len(tree), f"nothing is drawn, yet {wanted[0].tolist()} is visible"
    (index, _), distance = tree.query_nearest(as_points(page), return_distance=True, all_matches=False)
    worst = int(np.argmax(distance))
    assert distance[worst] <= tolerance_mm, (
        f"{int((distance > tolerance_mm).sum())} of {len(page)} visible points are not drawn; "
        f"{wanted[index[worst]].tolist()}, at {page[index[worst]].tolist()} mm, is {distance[worst]:.4g} mm away"
    )
    return len(page)


def edge_points(scene: Scene, samples: int, *, seed: int = 0) -> tuple[Floats, Ints]:
    """Random points on the edges of the faces of all items.

    Parameters
    ----------
    scene : Scene
        With its polyhedra.
    samples : int
        How many, in all.
    seed : int
        Of the random numbers.

    Returns
    -------
    (n, 3) array of float
        In the world.
    (n,) array of int
        The index of the item each lies on.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> cube = vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),))
    >>> points, item = testing.edge_points(cube, 10)
    >>> points.shape, item.any().item()
    ((10, 3), False)
    >>> bool((((points == 0.0) | (points == 2.0)).sum(axis=1) >= 2).all())
    True
    """
    lines, owner = [np.zeros((0, 2, 3))], [np.zeros(0, dtype=np.intp)]
    for index, item in enumerate(scene.items):
        lines.append(item.mesh.vertices[edges_of_faces(item.mesh)])
        owner.append(np.full(len(lines[-1]), index, dtype=np.intp))
    edges, items = np.concatenate(lines), np.concatenate(owner)
    which, share = some_of(edges, samples, np.random.default_rng(seed))
    part = share[: len(which), None]
    return edges[which, 0] * (1.0 - part) + edges[which, 1] * part, items[which]
