"""Whether two drawings show the same lines, however these are cut into strokes."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry import ragged
from vectorplot.geometry.vectors import dot, norm
from vectorplot.tolerances.of_lengths import COVERED_OF_TOLERANCE
from vectorplot.words import LineKind

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

    Degenerate: strokes of no length count as points.

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
