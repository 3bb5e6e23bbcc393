"""Polylines on the page, many at once: chosen, cut, reordered, joined where they touch, and cut off at rectangles."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import NO_CURVE, Paths
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import joined as joined_of_polylines
from vectorplot.geometry.polylines import take, with_points
from vectorplot.geometry.ragged import Keys, radix_order
from vectorplot.geometry.vectors import cross
from vectorplot.geometry.weld import close_points
from vectorplot.tolerances import SUM_OF_LENGTHS

# Choosing, reordering and cutting polylines, all at once.


def world_per_mm(paths: Paths) -> float:
    """The extent of the strokes in the world by that on the page; 0 without points or without extent."""
    if not len(paths.points):
        return 0.0
    mm, world = (float(max(np.ptp(axis) for axis in points.T)) for points in (paths.points, paths.points3d))
    return world / mm if mm > 0.0 else 0.0


def chosen(paths: Paths, which: Ints | Bools) -> Paths:
    """The strokes with these indices, in this order; or those where a mask is true."""
    return take(paths, which)


def concatenated(parts: tuple[Paths, ...]) -> Paths:
    """The strokes of all parts, one part after the other."""
    return joined_of_polylines(parts) if parts else Paths.empty()


def unrolled(paths: Paths, start: Ints, extra: Ints) -> Paths:
    """The same strokes as open ones: stroke i begins at its point start[i], goes round once, and extra[i] points on.

    extra of 1 closes a loop by repeating its first point; the number of points gives a second lap; 0 is for open
    strokes, which begin at 0.
    """
    counts = np.diff(paths.offsets)
    longer = counts + extra
    local = ragged.ranges(start, longer)
    index = np.repeat(paths.offsets[:-1], longer) + local % np.maximum(np.repeat(counts, longer), 1)
    open_ = np.zeros(len(paths), dtype=np.bool_)
    return replace(with_points(paths, index, np.arange(len(paths)), ragged.offsets(longer)), closed=open_)


def directed(directions: Floats, backwards: Bools) -> Floats:
    """(p,2) the directions at points, turned round at those that strokes run through backwards (p,) now."""
    turned = _known(directions, backwards)
    if not len(turned):
        return directions
    there, result = directions.take(turned, axis=0), directions.copy()
    result[turned] = np.where(there > 0.0, there - np.pi, there + np.pi)[:, ::-1]
    return result


def swapped(handles: Floats, backwards: Bools) -> Floats:
    """(p,2) the lengths of handles at points, those back and ahead changed where strokes run backwards (p,) now."""
    turned = _known(handles, backwards)
    if not len(turned):
        return handles
    result = handles.copy()
    result[turned] = handles.take(turned, axis=0)[:, ::-1]
    return result


def _known(values: Floats, which: Bools) -> Ints:
    """Those of some points (p,) of which one of two values (p,2) at least is known."""
    return np.flatnonzero(which & ~(np.isnan(values[:, 0]) & np.isnan(values[:, 1])))


def sections(
    paths: Paths, stroke: Ints, first: Ints, t_first: Floats, last: Ints, t_last: Floats, page_from_world: Floats
) -> Paths:
    """Parts of open strokes: part i of stroke[i], from the segment at point first[i], fraction t_first[i], to that of
    last[i], t_last[i]. Points in the world divide their segments so that their images are those on the page.
    Directions and handles are those of the points, unknown amid a segment.
    """
    offsets = ragged.offsets(last - first + 2)
    index = ragged.ranges(first, last - first + 2)
    points, points3d = paths.points.take(index, axis=0), paths.points3d.take(index, axis=0)
    directions, handles = (values.take(index, axis=0) for values in (paths.directions, paths.handles))
    for places, segment, t, there, point in (
        (offsets[:-1], first, t_first, t_first == 1.0, first + 1),
        (offsets[1:] - 1, last, t_last, t_last == 0.0, last),
    ):
        inside = np.flatnonzero((t != 0.0) & (t != 1.0))
        cut = places[inside]
        points[cut], points3d[cut] = _divided(paths, segment[inside], t[inside], page_from_world)
        directions[cut] = handles[cut] = np.nan
        # Parts that begin where their segment ends, or end where it begins.
        ends = np.flatnonzero(there)
        at, of = places.take(ends), point.take(ends)
        points[at], points3d[at] = paths.points.take(of, axis=0), paths.points3d.take(of, axis=0)
        directions[at], handles[at] = paths.directions.take(of, axis=0), paths.handles.take(of, axis=0)
    open_ = np.zeros(len(stroke), dtype=np.bool_)
    return Paths(
        points,
        offsets,
        open_,
        paths.kind[stroke],
        paths.item[stroke],
        paths.hidden_by[stroke],
        points3d,
        paths.smooth[stroke],
        directions,
        paths.curve[stroke],
        handles,
        paths.lamp[stroke],
    )


def _divided(paths: Paths, segment: Ints, t: Floats, page_from_world: Floats) -> tuple[Floats, Floats]:
    """The points at the fractions t of the segments, on the page and in the world; exact at 0 and 1."""
    a, b = paths.points.take(segment, axis=0), paths.points.take(segment + 1, axis=0)
    a3, b3 = paths.points3d.take(segment, axis=0), paths.points3d.take(segment + 1, axis=0)
    # Depths count by their ratio alone: powers of two keep what is very large within range, and all digits.
    reach, weight = (int(np.frexp(np.abs(some).max(initial=1.0))[1]) for some in ((a3, b3), page_from_world[3]))
    row = np.ldexp(page_from_world[3], (-weight, -weight, -weight, -weight - reach))
    depth_a, depth_b = (np.abs(matmul(np.ldexp(ends, -reach), row[:3]) + row[3]) for ends in (a3, b3))
    whole = t * depth_a + (1.0 - t) * depth_b
    # Both depths vanish only for points that have no image; they are divided as on the page.
    s = np.where(whole > 0.0, t * depth_a / np.where(whole > 0.0, whole, 1.0), t)
    return _mixed(a, b, t[:, None]), _mixed(a3, b3, s[:, None])


def _mixed(a: Floats, b: Floats, t: Floats) -> Floats:
    return np.where(t < 0.5, a + t * (b - a), b - (1.0 - t) * (b - a))


# Strokes that go on where the one before them ends, as they come: chords of one curve are traced one after the other,
# and need no search for what they touch.

SAME_PLACE = 100.0
"""Ends further apart in the world than so many tolerances on the page lie one behind the other."""


def segments_of(paths: Paths) -> tuple[Ints, Ints]:
    """(s,) the stroke that each segment of open strokes is of, and the point it begins at."""
    counts = np.diff(paths.offsets)
    starts = np.delete(np.arange(len(paths.points)), paths.offsets[1:][counts > 0] - 1)
    return ragged.owner(np.maximum(counts - 1, 0)), starts


def kept_parts(
    paths: Paths, owner: Ints, starts: Ints, segment: Ints, low: Floats, high: Floats, page_from_world: Floats
) -> tuple[Paths, Ints]:
    """Open strokes of which parts of segments are kept, and the stroke that each comes from.

    owner, starts: see segments_of; segment (k,): in order, kept from low (k,) to high (k,), 0 to 1.
    """
    goes_on = (np.diff(segment) == 1) & (high[:-1] == 1.0) & (low[1:] == 0.0)
    goes_on |= (np.diff(segment) == 0) & (high[:-1] == low[1:])
    goes_on &= owner[segment[1:]] == owner[segment[:-1]]
    begin = np.flatnonzero(np.append(True, ~goes_on)[: len(segment)])
    end = np.flatnonzero(np.append(~goes_on, True)[-len(segment) :]) if len(segment) else begin
    first, last = segment[begin], segment[end]
    stroke = owner[first]
    return sections(paths, stroke, starts[first], low[begin], starts[last], high[end], page_from_world), stroke


def going_on(paths: Paths, group: Ints, tolerance_mm: float) -> Bools:
    """(m,) which strokes begin where the one before them ends, within the tolerance on the page and in the world not
    behind it, both of them open parts of one curve, smooth or not, and of equal group (m,)."""
    result = np.zeros(len(paths), dtype=np.bool_)
    drawn = ~paths.closed & (np.diff(paths.offsets) > 1) & (paths.curve != NO_CURVE)
    same = drawn[1:] & drawn[:-1]
    for said in (paths.curve, paths.smooth, group):
        same &= said[1:] == said[:-1]
    which = np.flatnonzero(same)
    first = paths.offsets[1:][which]
    for places, reach in (
        (paths.points, tolerance_mm),
        (paths.points3d, SAME_PLACE * tolerance_mm * world_per_mm(paths)),
    ):
        apart = sum((axis[first] - axis[first - 1]) ** 2 for axis in places.T)
        which, first = (part[apart <= reach * reach] for part in (which, first))
    result[which + 1] = True
    return result


def in_rows(paths: Paths, going: Bools) -> Paths:
    """The strokes with those that go on (m,) from the one before them joined to it: they are of its kind, item, count
    and curve. Curves may change their direction at the joints."""
    if not going.any():
        return paths
    head = np.flatnonzero(~going)
    dropped = paths.offsets[:-1][going]
    kept = np.ones(len(paths.points), dtype=np.bool_)
    kept[dropped] = False
    counts = np.add.reduceat(np.diff(paths.offsets) - going, head)
    rows = with_points(paths, np.flatnonzero(kept), head, ragged.offsets(counts))
    directions, handles = paths.directions.copy(), paths.handles.copy()
    for values in (directions, handles):
        values[dropped - 1, 1] = values[dropped, 1]
    return replace(rows, directions=directions[kept], handles=handles[kept])


def without_dots(paths: Paths, tolerance_mm: float) -> Paths:
    """The strokes without the open ones of two points that are no longer than the tolerance."""
    two = np.flatnonzero(~paths.closed & (np.diff(paths.offsets) == 2))
    x, y = (axis[paths.offsets[two] + 1] - axis[paths.offsets[two]] for axis in paths.points.T)
    dots = two[x * x + y * y <= tolerance_mm * tolerance_mm]
    if not len(dots):
        return paths
    kept = np.ones(len(paths), dtype=np.bool_)
    kept[dots] = False
    return chosen(paths, kept)


# Chains of strokes that are linked end to end: who comes after whom, and which way round.

NO_END = -1


@dataclass(frozen=True, eq=False)
class Chains:
    """Strokes in sequence. Stroke i has the ends 2i (its first point) and 2i + 1 (its last).

    entry (m,): the end at which each stroke is entered, chain after chain; offsets (c+1,): where the chains begin;
    cyclic (c,): the last stroke of the chain is linked to its first.
    """

    entry: Ints
    offsets: Ints
    cyclic: Bools


def chains(mate: Ints) -> Chains:
    """The chains that links between ends make.

    mate (2m,): the end each end is linked to, or NO_END; mate[mate[e]] == e. Chains come in the order of their smallest
    end among those at which they begin or end (a cycle: its smallest stroke, entered at its first point).
    """
    states = np.arange(len(mate), dtype=np.intp)
    # A state is the end at which a stroke is entered; it is left at the other one, which differs in the last bit.
    following = mate[states ^ 1]
    last, steps, on_cycle = _ranked(following, np.flatnonzero(following != NO_END))
    if on_cycle.any():
        head = _cycle_heads(following, np.flatnonzero(on_cycle))
        before_head = mate[head[head == states]] ^ 1
        cut = following.copy()
        cut[before_head] = NO_END
        ring_last, ring_steps, _ = _ranked(cut, np.flatnonzero(on_cycle & (cut != NO_END)))
        last, steps = np.where(on_cycle, ring_last, last), np.where(on_cycle, ring_steps, steps)
        keep = np.where(on_cycle, (head & 1) == 0, last ^ 1 > last[states ^ 1] ^ 1)
        chain = np.where(on_cycle, head, last[states ^ 1] ^ 1)
    else:
        keep = last ^ 1 > last[states ^ 1] ^ 1
        chain = last[states ^ 1] ^ 1
    states = states[keep]
    chain, steps, cyclic = chain[keep], steps[keep], on_cycle[keep]
    sizes = np.bincount(chain, minlength=len(mate))
    ends = np.cumsum(sizes)
    entry = np.zeros_like(states)
    entry[ends[chain] - 1 - steps] = states
    used = np.flatnonzero(sizes)
    flags = np.zeros(len(mate), dtype=np.bool_)
    flags[chain] = cyclic
    return Chains(entry, np.concatenate(([0], ends[used])).astype(np.intp), flags[used])


def _ranked(following: Ints, active: Ints) -> tuple[Ints, Ints, Bools]:
    """For every active state the last one of its chain, the steps to it, and whether it lies on a cycle.

    Source: Wyllie, The complexity of parallel computations (1979): list ranking by pointer jumping.
    """
    last = np.where(following == NO_END, np.arange(len(following)), following)
    steps = (following != NO_END).astype(np.intp)
    on_cycle = np.zeros(len(following), dtype=np.bool_)
    ended = following == NO_END
    while len(active):
        at = last[active]
        arrived = ended[at]
        if not arrived.any():
            on_cycle[active] = True
            break
        # All new values are computed from the old ones before any is stored.
        further, more = last[at], steps[active] + steps[at]
        last[active], steps[active] = further, more
        ended[active[arrived]] = True
        active = active[~arrived]
    return last, steps, on_cycle


def _cycle_heads(following: Ints, members: Ints) -> Ints:
    """For every state on a cycle the smallest state of the cycle; NO_END for the others."""
    head = np.full(len(following), NO_END, dtype=np.intp)
    head[members] = members
    jump = following.copy()
    while True:
        at = jump[members]
        smaller = np.minimum(head[members], head[at])
        if np.array_equal(smaller, head[members]):
            return head
        head[members] = smaller
        jump[members] = jump[at]


# Which points of a plane come close to each other: a hashed grid whose cells overlap, so that no border separates.

CELL = 16.0
"""Width of a cell in units of the reach: a wide cell has few points near its border, a narrow one few in all."""

_MIX = tuple(np.uint64(odd) for odd in (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9))


_FEWEST_BITS, _LEADING_BITS = 48, 30
"""Keys with their owners are put in order by the first so many bits, if as many of the key are among them that hardly
any different keys agree in these; otherwise by 64."""


def hashed(*parts: Ints) -> Keys:
    """(n,) 64-bit numbers, equal for equal tuples of integers and nearly always different for different ones."""
    key = parts[0].astype(np.uint64) * _MIX[0]
    for part in parts[1:]:
        key ^= key >> np.uint64(29)
        key = (key + part.astype(np.uint64)) * _MIX[1]
    key ^= key >> np.uint64(32)
    return np.asarray(key * _MIX[2], dtype=np.uint64)


def overlapping_cells(x: Floats, y: Floats, label: Ints, reach: tuple[float, float]) -> tuple[Keys, Ints]:
    """(key, owner): the cells of points x, y, label (n,), most in one, few in two or four. Points of equal label within
    reach, in x and in y, share a cell; points that share one need not be close.
    """
    cell = (CELL * reach[0], CELL * reach[1])
    column, row = np.floor(x / cell[0]), np.floor(y / cell[1])
    left = x - column * cell[0] <= 1.001 * reach[0]
    low = y - row * cell[1] <= 1.001 * reach[1]
    column, row = column.astype(np.int64), row.astype(np.int64)
    parts = [(np.arange(len(x)), 0, 0)]
    parts += [(np.flatnonzero(left), 1, 0), (np.flatnonzero(low), 0, 1), (np.flatnonzero(left & low), 1, 1)]
    owner = np.concatenate([part[0] for part in parts])
    sizes = [len(part[0]) for part in parts]
    step_x, step_y = (np.repeat([part[axis] for part in parts], sizes) for axis in (1, 2))
    return hashed(column.take(owner) - step_x, row.take(owner) - step_y, label.take(owner)), owner


def companions(key: Keys, owner: Ints) -> tuple[Ints, Ints]:
    """(owner, starts): the owners of all keys that occur more than once, key after key, ascending.

    starts (r+1,): where the runs of equal keys begin.

    Keys are compared by their leading bits; different keys may therefore fall into one run, equal ones never into two.
    """
    if not len(key):
        return owner, np.zeros(1, dtype=np.intp)
    of_owner = int(owner.max()).bit_length()
    width = _FEWEST_BITS if of_owner <= _FEWEST_BITS - _LEADING_BITS else 64
    bits = np.uint64(of_owner)
    packed = key >> np.uint64(64 - width + of_owner) << bits | owner.astype(np.uint64)
    packed = packed.take(radix_order(packed, width))
    leading = packed >> bits
    same = leading[1:] == leading[:-1]
    shared = np.concatenate((same, [False])) | np.concatenate(([False], same))
    first = shared & ~np.concatenate(([False], same))
    owner = (packed[shared] & ((np.uint64(1) << bits) - np.uint64(1))).astype(np.intp)
    starts = np.concatenate((np.flatnonzero(first[shared]), [len(owner)]))
    return owner, starts.astype(np.intp)


def clusters(x: Floats, y: Floats, label: Ints, reach: float) -> Ints:
    """(n,) for every point the smallest index of a point it is connected to.

    Points of equal label are connected by steps no longer than reach. Within a dense group of several reaches' width
    not every step is found, but equal points always get equal clusters.
    """
    owner, starts = companions(*overlapping_cells(x, y, label, (reach, reach)))
    run = ragged.owner(np.diff(starts))
    links = []
    while len(owner):
        # Every run's first point takes all that are close to it; the rest tries again among itself.
        first = np.concatenate(([True], run[1:] != run[:-1]))
        head = owner[first][np.cumsum(first) - 1]
        close = (np.hypot(x[owner] - x[head], y[owner] - y[head]) <= reach) & (label[owner] == label[head])
        links.append((owner[close & ~first], head[close & ~first]))
        owner, run = owner[~close], run[~close]
    if not links:
        return np.arange(len(x), dtype=np.intp)
    return connected(len(x), *(np.concatenate(column) for column in zip(*links, strict=True)))


def connected(count: int, high: Ints, low: Ints) -> Ints:
    """(count,) the smallest index of each one's component in the graph with the links high[i] - low[i], high > low."""
    parent = np.arange(count, dtype=np.intp)
    parent[high] = low
    while True:
        above = parent[parent]
        while not np.array_equal(above, parent):
            parent = above
            above = parent[parent]
        one, two = parent[high], parent[low]
        differ = one != two
        if not differ.any():
            return parent
        high, low = np.maximum(one, two)[differ], np.minimum(one, two)[differ]
        np.minimum.at(parent, high, low)


# Touching strokes as long polylines: the pen stays down.

_TURN = 1 << 30
"""Directions are whole numbers of this part of a full turn: sums and comparisons of angles are exact."""


def joined(paths: Paths, group: Ints, tolerance_mm: float) -> Paths:
    """The same lines in as few and long strokes as their ends allow. group (m,): only strokes of one group, smooth with
    smooth, are joined; the result has the kind, item and hidden_by of its first part. Ends within tolerance_mm are
    one node unless they differ in depth; at a node the straightest pairs are joined first.
    Edge cases: closed strokes stay, last; a straight stroke with both ends at one node is left out; two straight
    strokes between the same two nodes become one.
    """
    sizes = np.diff(paths.offsets)
    open_ = np.flatnonzero(~paths.closed & (sizes > 1))
    if not len(open_):
        return chosen(paths, paths.closed) if (~paths.closed).any() else paths
    node = _nodes_of(paths, open_, group, tolerance_mm)
    dot = (node[::2] == node[1::2]) & (sizes[open_] == 2)
    if dot.any():
        rest = np.sort(np.concatenate((open_[~dot], np.flatnonzero(paths.closed))))
        return joined(chosen(paths, rest), group[rest], tolerance_mm)
    return _assembled(paths, open_, chains(_linked(paths, open_, node, tolerance_mm)))


def linked_ends(paths: Paths, group: Ints, tolerance_mm: float) -> Ints:
    """(2m,) the end that each end of open strokes, start (even) or end (odd), is joined to by joined, or NO_END."""
    going = going_on(paths, group, tolerance_mm)
    head = np.flatnonzero(~going)
    rows = in_rows(paths, going)
    every = np.arange(len(rows))
    mate = _linked(rows, every, _nodes_of(rows, every, group[head], tolerance_mm), tolerance_mm)
    # The ends of the rows are the first ends of their first strokes and the last ends of their last ones.
    end = np.stack((2 * head, 2 * np.append(head[1:], len(paths)) - 1), axis=1).ravel()
    result = np.full(2 * len(paths), NO_END, dtype=np.intp)
    result[end] = np.where(mate == NO_END, NO_END, end[mate])
    inner = np.flatnonzero(going)
    result[2 * inner], result[2 * inner - 1] = 2 * inner - 1, 2 * inner
    return result


def _ends_of(paths: Paths, open_: Ints) -> Ints:
    """(2k,) the first and last points of some strokes."""
    return np.stack((paths.offsets[open_], paths.offsets[open_ + 1] - 1), axis=1).ravel()


def _nodes_of(paths: Paths, open_: Ints, group: Ints, tolerance_mm: float) -> Ints:
    alike = 2 * group + paths.smooth
    return _nodes(paths.points.take(_ends_of(paths, open_), axis=0), np.repeat(alike[open_], 2), tolerance_mm)


def _linked(paths: Paths, open_: Ints, node: Ints, tolerance_mm: float) -> Ints:
    ends = _ends_of(paths, open_)
    reach = SAME_PLACE * tolerance_mm * world_per_mm(paths)
    return _mates(paths, ends[::2], ends[1::2], _parted(node, paths.points3d.take(ends, axis=0), reach))


def _parted(node: Ints, ends: Floats, reach: float) -> Ints:
    """(2m,) the nodes, those parted whose ends (2m,3) are further apart in the world than reach."""
    wide = np.zeros(int(node.max(initial=-1)) + 1, dtype=np.bool_)
    # Most ends are alone at their nodes.
    shared = np.flatnonzero(np.bincount(node).take(node) > 1)
    order = shared[np.argsort(node.take(shared), kind="stable")]
    begin = np.flatnonzero(np.diff(node.take(order), prepend=-1))
    if not len(begin):
        return node
    of = node.take(order.take(begin))
    for axis in range(3):
        along = ends[order, axis]
        wide[of] |= np.maximum.reduceat(along, begin) - np.minimum.reduceat(along, begin) > reach
    if not wide.any():
        return node
    some = np.flatnonzero(wide[node])
    place = close_points(ends[some], reach)
    parted = node.copy()
    parted[some] = len(wide) + np.unique(node[some] * len(some) + place, return_inverse=True)[1]
    return parted


def _nodes(ends: Floats, group: Ints, tolerance_mm: float) -> Ints:
    """(2m,) the node of the start (even) and end (odd) of every stroke, numbered from 0."""
    x, y = (axis - axis.min() for axis in ends.T)
    head = clusters(x, y, group, tolerance_mm)
    number = np.cumsum(head == np.arange(len(head))) - 1
    return np.asarray(number[head], dtype=np.intp)


def _mates(paths: Paths, first: Ints, last: Ints, node: Ints) -> Ints:
    """(2m,) the end that each end is joined to, or NO_END."""
    mate = np.full(len(node), NO_END, dtype=np.intp)
    degree = np.bincount(node)
    ends = np.flatnonzero(degree[node] == 2)
    ends = ends[np.argsort(node[ends], kind="stable")]
    mate[ends[::2]], mate[ends[1::2]] = ends[1::2], ends[::2]
    ends = np.flatnonzero(degree[node] > 2)
    if len(ends):
        stroke, at_end = ends >> 1, ends & 1
        here = np.where(at_end, last[stroke], first[stroke])
        inward = paths.points.take(here + np.where(at_end, -1, 1), axis=0) - paths.points.take(here, axis=0)
        angle = np.rint(arctan2(inward[:, 1], inward[:, 0]) * (_TURN / (2.0 * np.pi))).astype(np.intp) % _TURN
        _pair_straightest(mate, ends, np.unique(node[ends], return_inverse=True)[1] * _TURN + angle)
    return mate


def _pair_straightest(mate: Ints, ends: Ints, key: Ints) -> None:
    """Join the ends at each node, the straightest pairs first; key: node times _TURN plus direction.

    In each round every end looks for the one that is most nearly opposite, and pairs that choose each other are joined.
    """
    order = np.lexsort((ends, key))
    ends, key = ends[order], key[order]
    while len(ends) > 1:
        node = key // _TURN
        begin = np.flatnonzero(np.concatenate(([True], node[1:] != node[:-1])))
        run = np.cumsum(np.concatenate(([0], node[1:] != node[:-1])))
        last = np.append(begin[1:], len(ends))[run] - 1
        begin = begin[run]
        choice = _most_opposite(key, node, begin, last)
        place = np.arange(len(ends))
        chosen_ = (choice[choice] == place) & (choice != place)
        if not chosen_.any():
            return
        mate[ends[chosen_]] = ends[choice[chosen_]]
        ends, key = ends[~chosen_], key[~chosen_]


def _most_opposite(key: Ints, node: Ints, begin: Ints, last: Ints) -> Ints:
    """For each direction, sorted by node and angle, the place of the one at its node that is nearest to its opposite.

    Equal directions choose among equal ones by their rank; of two that are as near the first counts: so the best pair
    of all at a node always choose each other. begin, last: places of the first and last direction of the same node.
    """
    place = np.arange(len(key))
    angle = key - node * _TURN
    above = np.searchsorted(key, node * _TURN + (angle + _TURN // 2) % _TURN)
    above = np.where(above > last, begin, above)
    below = np.where(above == begin, last, above - 1)
    first = np.searchsorted(key, key)
    size = np.searchsorted(key, key, side="right") - first
    rank = place - first
    options = []
    for at in (above, below):
        among = first[at]
        own = np.where((rank ^ 1) < size, first + (rank ^ 1), first)
        own = np.where(size == 1, np.where(place == last, begin, place + 1), own)
        options.append(np.where(among == first, own, among + np.minimum(rank, size[at] - 1)))
    bends = [np.abs(np.abs(angle[at] - angle) - _TURN // 2) for at in options]
    second = (bends[1] < bends[0]) | ((bends[1] == bends[0]) & (first[options[1]] < first[options[0]]))
    return np.where(second, options[1], options[0])


def _assembled(paths: Paths, open_: Ints, order: Chains) -> Paths:
    """The chains as strokes, and the closed strokes of paths after them."""
    stroke, backwards = open_[order.entry >> 1], (order.entry & 1) == 1
    counts = np.diff(paths.offsets)[stroke]
    # At a joint the later part's first point is left out; in a ring at every joint.
    head = np.zeros(len(stroke), dtype=np.bool_)
    head[order.offsets[:-1]] = ~order.cyclic
    dropped = (~head).astype(np.intp)
    kept = counts - dropped
    begin = np.where(backwards, paths.offsets[stroke + 1] - 1 - dropped, paths.offsets[stroke] + dropped)
    loops = np.flatnonzero(paths.closed)
    loop_counts = np.diff(paths.offsets)[loops]
    index = _stepped(begin, kept, backwards)
    index = np.concatenate((index, ragged.ranges(paths.offsets[loops], loop_counts)))
    counts = np.concatenate((np.add.reduceat(kept, order.offsets[:-1]), loop_counts))
    source = np.concatenate((stroke[order.offsets[:-1]], loops))
    closed = np.concatenate((order.cyclic, np.ones(len(loops), dtype=np.bool_)))
    closed[: len(order.cyclic)] &= counts[: len(order.cyclic)] > 2
    whole = with_points(paths, index, source, ragged.offsets(counts))
    turned = np.zeros(len(index), dtype=np.bool_)
    turned[: kept.sum()] = np.repeat(backwards, kept)
    directions, handles = directed(whole.directions, turned), swapped(whole.handles, turned).copy()
    later = np.flatnonzero(dropped)
    joint, first, back = _joints(order, kept, later), np.where(backwards, begin + 1, begin - 1)[later], backwards[later]
    directions[joint, 1] = directed(paths.directions.take(first, axis=0), back)[:, 1]
    handles[joint, 1] = swapped(paths.handles.take(first, axis=0), back)[:, 1]
    return replace(whole, closed=closed, directions=directions, handles=handles)


def _joints(order: Chains, kept: Ints, later: Ints) -> Ints:
    """(j,) where the points stand at which strokes (j,), which lose their first one, are joined to those before
    them."""
    last = np.cumsum(kept) - 1
    before = np.arange(len(kept)) - 1
    before[order.offsets[:-1]] = order.offsets[1:] - 1
    return last[before[later]]


def _stepped(begin: Ints, counts: Ints, backwards: Bools) -> Ints:
    """The indices begin[i], begin[i] + 1, ..., or begin[i] - 1, ... (counts[i] of them), range after range."""
    local = ragged.place(counts)
    index: Ints = np.repeat(begin, counts) + np.where(np.repeat(backwards, counts), -local, local)
    return index


# Long strokes in parts: some plotters stutter on paths of many metres.


def split_long(paths: Paths, max_mm: float, page_from_world: Floats | None = None) -> Paths:
    """The same strokes, those longer than a limit cut into equal parts that are no longer, one after the other.

    Parameters
    ----------
    paths : Paths
        On the page, in mm.
    max_mm : float
        The longest that a stroke may be.
    page_from_world : (4, 4) array of float, optional
        See Drawing, by default a parallel projection: points3d is divided where the page is.

    Returns
    -------
    Paths
        A closed stroke that is cut becomes open ones.

    Raises
    ------
    InputError
        Unless the limit is positive.

    Notes
    -----
    Edge cases: strokes without length stay.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.drawing import split_long
    >>> from vectorplot.drawing.drawing import Paths
    >>> points, none = np.array([(0.0, 0.0), (100.0, 0.0)]), np.zeros(1, dtype=int)
    >>> line = Paths(points, np.array([0, 2]), np.array([False]), none, none, none, np.zeros((2, 3)))
    >>> split_long(line, max_mm=60.0).points.tolist()
    [[0.0, 0.0], [50.0, 0.0], [50.0, 0.0], [100.0, 0.0]]
    """
    if not max_mm > 0.0:
        raise InputError(f"the longest stroke must be a positive length in mm, not {max_mm:g}")
    loops = paths.closed & (np.diff(paths.offsets) > 0)
    line = unrolled(paths, np.zeros(len(paths), dtype=np.intp), loops.astype(np.intp))
    along, length = _arc_length(line)
    # Rounding of the sum must not make a stroke of exactly the right length too long.
    parts = np.ceil(length / max_mm * (1.0 - SUM_OF_LENGTHS))
    cut = parts > 1.0
    if not cut.any():
        return paths
    count = parts[cut].astype(np.intp)
    stroke = np.repeat(np.flatnonzero(cut), count)
    number, count = ragged.place(count), np.repeat(count, count)
    first, last = line.offsets[:-1][stroke], line.offsets[1:][stroke] - 1
    begin = along[first] + number * (length[stroke] / count)
    end = along[first] + (number + 1) * (length[stroke] / count)
    start_at, t_start = _on_segment(along, np.searchsorted(along, begin, side="right") - 1, begin, first, last)
    end_at, t_end = _on_segment(along, np.searchsorted(along, end, side="left") - 1, end, first, last)
    # The ends of the whole are its own ends, whatever the sums round to.
    start_at, t_start = np.where(number == 0, first, start_at), np.where(number == 0, 0.0, t_start)
    end_at, t_end = np.where(number == count - 1, last - 1, end_at), np.where(number == count - 1, 1.0, t_end)
    world = np.eye(4) if page_from_world is None else page_from_world
    pieces = sections(line, stroke, start_at, t_start, end_at, t_end, world)
    order = np.argsort(np.concatenate((np.flatnonzero(~cut), stroke)), kind="stable")
    return chosen(concatenated((chosen(paths, ~cut), pieces)), order)


def _arc_length(line: Paths) -> tuple[Floats, Floats]:
    """How far along all open strokes, laid end to end, each point lies (p,); and the length of each stroke (m,)."""
    steps = np.zeros(len(line.points))
    steps[1:] = np.hypot(*np.diff(line.points, axis=0).T)
    filled = np.diff(line.offsets) > 0
    steps[line.offsets[:-1][filled]] = 0.0
    along = np.cumsum(steps)
    length = np.zeros(len(line))
    length[filled] = along[line.offsets[1:][filled] - 1] - along[line.offsets[:-1][filled]]
    return along, length


def _on_segment(along: Floats, segment: Ints, place: Floats, first: Ints, last: Ints) -> tuple[Ints, Floats]:
    """The segment of the stroke from first to last, and the fraction of it, at a place along."""
    segment = np.clip(segment, first, last - 1)
    run = along[segment + 1] - along[segment]
    return segment, np.clip((place - along[segment]) / np.where(run > 0.0, run, 1.0), 0.0, 1.0)


# Cutting a drawing's strokes off at a rectangle of the page.

Rectangle = tuple[float, float, float, float]
"""Left, bottom, right, top in mm."""


def clipped(paths: Paths, rectangle: Rectangle, page_from_world: Floats | None = None) -> Paths:
    """The parts of the strokes inside the rectangle, as clipped_parts gives them."""
    return clipped_parts(paths, rectangle, page_from_world)[0]


def clipped_parts(paths: Paths, rectangle: Rectangle, page_from_world: Floats | None = None) -> tuple[Paths, Ints]:
    """The parts of strokes within the rectangle (left, bottom, right, top in mm), border included, in order, and the
    stroke each comes from. page_from_world (4,4) as in Drawing, by default parallel: points3d is cut where the page
    is. A closed stroke that is cut becomes open ones.
    Edge cases: what only touches the border leaves nothing; of a segment 1e15 times as long as the rectangle nothing
    may be left. Source: Liang and Barsky, ACM Trans. Graphics 3 (1984).
    """
    low, high = np.array(rectangle[:2]), np.array(rectangle[2:])
    outside: Bools = np.any((paths.points < low) | (paths.points > high), axis=1)
    if not outside.any():
        return paths, np.arange(len(paths))
    leaves = _any_in_each(outside, paths.offsets)
    index = np.flatnonzero(leaves)
    cut = chosen(paths, index)
    cut = unrolled(
        cut, np.where(cut.closed, _first_in_each(outside, paths.offsets, index), 0), cut.closed.astype(np.intp)
    )
    world = np.eye(4) if page_from_world is None else page_from_world
    parts, stroke = _inside(cut, low, high, world)
    whole = chosen(paths, ~leaves)
    source = np.concatenate((np.flatnonzero(~leaves), index[stroke]))
    order = np.argsort(source, kind="stable")
    return chosen(concatenated((whole, parts)), order), source[order]


def _any_in_each(flags: Bools, offsets: Ints) -> Bools:
    before = ragged.offsets(flags)[offsets]
    return before[1:] > before[:-1]


def _first_in_each(flags: Bools, offsets: Ints, index: Ints) -> Ints:
    """For each of the strokes of the index the place of its first flagged point within the stroke."""
    places = np.flatnonzero(flags)
    return places[np.searchsorted(places, offsets[index])] - offsets[index]


def _inside(paths: Paths, low: Floats, high: Floats, page_from_world: Floats) -> tuple[Paths, Ints]:
    """The parts of open strokes inside the box, and the stroke each one comes from."""
    counts = np.diff(paths.offsets)
    owner = ragged.owner(np.maximum(counts - 1, 0))
    starts = np.delete(np.arange(len(paths.points)), paths.offsets[1:][counts > 0] - 1)
    a, b = paths.points[starts], paths.points[starts + 1]
    t0, axis0 = _entered(a, b, low, high)
    t1, axis1 = _entered(b, a, low, high)
    t1 = 1.0 - t1
    kept = np.flatnonzero(t0 < t1)
    goes_on = (np.diff(starts[kept]) == 1) & (t1[kept[:-1]] == 1.0) & (t0[kept[1:]] == 0.0)
    goes_on &= owner[kept[1:]] == owner[kept[:-1]]
    begin = kept[np.concatenate(([True], ~goes_on))[: len(kept)]]
    end = kept[np.concatenate((~goes_on, [True]))[: len(kept)]]
    parts = sections(paths, owner[begin], starts[begin], t0[begin], starts[end], t1[end], page_from_world)
    # Rounding may leave a cut beside the border it lies on, far beside it if the segment is very long.
    _pinned(parts.points, parts.offsets[:-1], axis0[begin], (b > a)[begin], low, high)
    _pinned(parts.points, parts.offsets[1:] - 1, axis1[end], (a > b)[end], low, high)
    np.clip(parts.points, low, high, out=parts.points)
    return parts, owner[begin]


def _pinned(points: Floats, places: Ints, axis: Ints, rises: Bools, low: Floats, high: Floats) -> None:
    """Put cut ends on the border they cross: the lower one where the segment rises into the box. axis -1 is no cut."""
    cut = np.flatnonzero(axis >= 0)
    side = axis[cut]
    points[places[cut], side] = np.where(rises[cut, side], low[side], high[side])


def _entered(a: Floats, b: Floats, low: Floats, high: Floats) -> tuple[Floats, Ints]:
    """The parameter at which each segment from a to b enters the box, and through a border across which axis.

    0 and -1 where a is inside; infinite where the segment runs beside the box.
    """
    t, across = np.zeros(len(a)), np.full(len(a), -1)
    for axis in (0, 1):
        start, run = a[:, axis], b[:, axis] - a[:, axis]
        border = np.where(run > 0.0, low[axis], high[axis])
        before = np.where(run > 0.0, start < border, start > border)
        outside = (start < low[axis]) | (start > high[axis])
        with np.errstate(over="ignore"):  # a run of almost nothing: that it ends outside is all that counts
            entry = (border - start) / np.where(run != 0.0, run, 1.0)
        entry = np.where(outside & ((run == 0.0) | ~before), np.inf, np.where(before, entry, 0.0))
        across = np.where(entry > t, axis, across)
        t = np.maximum(t, entry)
    return t, across


# Cutting strokes off at a ring on the page.

AT_ONCE = 1 << 20
"""So many segments, each for a side of a ring, are looked at together."""


def inside_ring(paths: Paths, ring: Floats) -> Paths:
    """The parts of strokes of a parallel view inside of a ring (k,2) that does not cross itself, in order; closed ones
    become open. Edge cases: what lies along the ring may be inside or not."""
    return _divided_by_ring(paths, ring)[0]


def outside_ring(paths: Paths, ring: Floats) -> Paths:
    """The parts outside of it, see inside_ring."""
    return _divided_by_ring(paths, ring)[1]


def _divided_by_ring(paths: Paths, ring: Floats) -> tuple[Paths, Paths]:
    """The parts of strokes inside and outside of a ring."""
    if not len(paths.points):
        return paths, paths
    cut = unrolled(paths, np.zeros(len(paths), dtype=np.intp), paths.closed.astype(np.intp))
    owner, starts = segments_of(cut)
    a, b = cut.points[starts], cut.points[starts + 1]
    size = max(AT_ONCE // len(ring), 1)
    found = [_crossings(a[k : k + size], b[k : k + size], ring) for k in range(0, len(a), size)]
    count = np.concatenate([np.zeros(0, dtype=np.intp), *(np.bincount(s, minlength=n) for s, _, n in found)])
    every = np.arange(len(a))
    segment = np.concatenate([every, every, np.repeat(every, count)])
    at = np.concatenate([np.zeros(len(a)), np.ones(len(a)), *(t for _, t, _ in found)])
    order = np.lexsort((at, segment))
    segment, at = segment[order], at[order]
    part = np.flatnonzero((segment[1:] == segment[:-1]) & (at[1:] > at[:-1]))
    low, high, segment = at[part], at[part + 1], segment[part]
    middle = _mixed(a[segment], b[segment], (0.5 * (low + high))[:, None])
    inside = np.concatenate(
        [np.zeros(0, dtype=np.bool_), *(_is_inside(middle[k : k + size], ring) for k in range(0, len(middle), size))]
    )
    both = (
        kept_parts(cut, owner, starts, segment[some], low[some], high[some], np.eye(4))[0] for some in (inside, ~inside)
    )
    kept, rest = both
    return kept, rest


def _crossings(start: Floats, end: Floats, ring: Floats) -> tuple[Ints, Floats, int]:
    """Where segments from start to end (s,2) cross the sides of a ring (k,2): the segment and its parameter, of each in
    the order of segments; and how many segments there are."""
    along, side = (end - start)[:, None], np.roll(ring, -1, axis=0) - ring
    away = ring - start[:, None]
    turn = cross(along, side)
    divisor = np.where(turn != 0.0, turn, 1.0)
    t = cross(away, side) / divisor
    u = cross(away, along) / divisor
    segment, which = np.nonzero((turn != 0.0) & (t > 0.0) & (t < 1.0) & (u >= 0.0) & (u < 1.0))
    return segment, t[segment, which], len(start)


def _is_inside(points: Floats, ring: Floats) -> Bools:
    """Whether points (n,2) are inside of a ring: a ray to the right crosses it an odd number of times."""
    after = np.roll(ring, -1, axis=0)
    x, y = points[:, :1], points[:, 1:]
    rises = (ring[:, 1] > y) != (after[:, 1] > y)
    slope = (after[:, 0] - ring[:, 0]) / np.where(after[:, 1] != ring[:, 1], after[:, 1] - ring[:, 1], 1.0)
    crossed = rises & (x < ring[:, 0] + (y - ring[:, 1]) * slope)
    return np.asarray(crossed.sum(axis=1) % 2 == 1)
