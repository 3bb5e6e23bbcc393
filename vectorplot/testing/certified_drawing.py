"""The shapes of a certificate, and the strokes of a drawing, in the image: what the checker compares.

It belongs to `check_certificate.py`, and imports nothing but numpy and what stands beside it either.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING or __package__:
    from . import certified_image as geo
    from . import certified_surfaces as formulas
else:
    import certified_image as geo
    import certified_surfaces as formulas

EDGE_KINDS = ("contour", "boundary", "crease")
FACE_KINDS = ("intersection", "pattern", "section", "isophote", "parameter", "integral")
OFF, DEEP, WIDEST = 0.5, 40.0, 0.02
"""Times what is left open: nets and pieces may be so much off their surfaces, and strokes in depth. Part of the page
that may be left open at most."""
SHARES, ROUNDS, STEEP = 4, 5, 8.0
"""Pieces are divided into so many parts, and these again, so many times, to prove that they are isophotes; ways are so
many times longer on a surface than on the page at most."""


class Limits(NamedTuple):
    """What is left open, in mm, and what the drawing is said to be: see the file."""

    width: float
    size: float
    fine: float
    angle: float
    gap: float | None
    window: geo.Floats

    @property
    def ratio(self) -> float:
        """Parts that are not looked at are so many times as long as what is left open is wide."""
        return self.size / self.width


class Shapes(NamedTuple):
    """The shapes of a certificate in the image. view: rows of the image; items: their rows; names: which item each name
    is of; patches: surfaces, each with its item; sides: edges; ends (e,2): their vertices; side_item (e,): which item
    they are of; may: which of them each kind may show; wanted (w,): those that are drawn or hidden; of, item (t,):
    triangles; cells (c,9): where contours of surfaces are, see contour_cells; cell_item (c,); drawn (c,): whether they
    need be; off: mm that rounding may do; smooth: something hides that is not certified; coarse: what is wrong with
    nets, a few words each."""

    limits: Limits
    view: geo.Floats
    items: list[Any]
    names: dict[str, int]
    patches: list[tuple[int, formulas.Patch]]
    sides: geo.Segments
    ends: geo.Ints
    side_item: geo.Ints
    may: dict[str, geo.Bools]
    wanted: geo.Ints
    of: geo.Triangles
    item: geo.Ints
    cells: geo.Floats
    cell_item: geo.Ints
    drawn: geo.Bools
    off: float
    smooth: bool
    coarse: list[str]


class Model(NamedTuple):
    """The strokes of a drawing in the image. strokes: their segments, those on surfaces as pieces of these; whole: as
    they are drawn; bare: parts that should be on surfaces, and are not; lifted (m,): strokes on them; proved (s,):
    segments of strokes to prove; doubt (s,): those that may be no isophotes; kind, hidden, item (m,): of each stroke,
    -1 for no item; shift (p,): mm that points are off their places; off: mm that rounding may do."""

    strokes: geo.Segments
    whole: geo.Segments
    bare: geo.Parts
    lifted: geo.Bools
    proved: geo.Bools
    doubt: geo.Bools
    kind: NDArray[np.str_]
    hidden: geo.Bools
    item: geo.Ints
    shift: geo.Floats
    off: float


def stacked(lists: list[Any], columns: int) -> tuple[geo.Floats, geo.Ints]:
    """The rows of all lists as (n,columns), and how many each has. Errors: ValueError for what is not finite."""
    rows = np.array([row for one in lists for row in one], dtype=np.float64).reshape(-1, columns)
    if not np.isfinite(rows).all():
        raise ValueError("a number is not finite")
    return rows, np.array([len(one) for one in lists], dtype=np.intp)


def named_parts(table: geo.Floats, names: geo.Ints) -> tuple[geo.Parts, geo.Ints]:
    """Those of some rows (two numbers that name a segment, from, to, by what) that are parts of segments with the names
    (n,2), in rising order; and which rows."""
    base = float(max(names.max(initial=0), table[:, :2].max(initial=0))) + 1.0
    keys, key = np.append(names[:, 0] * base + names[:, 1], np.inf), table[:, 0] * base + table[:, 1]
    line = np.searchsorted(keys, key)
    within = (0.0 <= table[:, 2]) & (table[:, 2] <= table[:, 3]) & (table[:, 3] <= 1.0)
    kept = np.flatnonzero((keys[line] == key) & within)
    return geo.Parts(line[kept], table[kept, 2], table[kept, 3], table[kept, 4].astype(np.intp)), kept


def places_of(lines: geo.Segments) -> geo.Ints:
    """(n,2) the numbers of strokes, in rising order, and of the segments in each."""
    return np.stack([lines.owner, np.arange(len(lines.owner)) - np.searchsorted(lines.owner, lines.owner)], axis=1)


def on_surfaces(
    lines: geo.Segments, rows: Any, kinds: Any, items: geo.Ints, shapes: Shapes
) -> tuple[geo.Segments, geo.Parts, geo.Bools]:
    """Straight pieces, which follow surfaces, of segments that do, parameter lines, sections and isophotes as their
    items say; what parts these are; and which of them are not proved to be isophotes, though they should be.
    rows: the number of a segment (2), from, to, which surface, u and v at both ends (4); kinds, items (m,): of
    strokes."""
    table, slack = stacked([rows], 9)[0], shapes.limits.fine
    parts, kept = named_parts(table, places_of(lines))
    ends, (right, doubt) = table[kept, 5:], np.zeros((2, len(kept)), dtype=np.bool_)
    start, end = np.zeros((2, len(kept), 3))
    for number, (item, surface) in enumerate(shapes.patches):
        own = np.flatnonzero((parts.by == number) & (items[lines.owner[parts.line]] == item))
        (u, v), word = ends[own].reshape(-1, 2, 2).transpose(2, 0, 1), kinds[lines.owner[parts.line[own]]]
        cells = np.hstack([np.sort(u, axis=1), np.sort(v, axis=1)])
        inside = (cells[:, ::2] >= [surface.u[0], surface.v[0]]) & (cells[:, 1::2] <= [surface.u[-1], surface.v[-1]])
        close = formulas.deviations(surface, shapes.view, cells).sum(axis=1) <= OFF * slack
        points = surface.points(u, v)
        image = geo.placed(shapes.view, points)
        start[own], end[own] = image.swapaxes(0, 1)
        along = ~np.isin(word, ["parameter", "section"])
        for axis, values in enumerate(shapes.items[item]["parameters"]):
            lined = np.array([-np.inf, *sorted(map(float, values)), np.inf])
            after = np.searchsorted(lined, ends[own, axis]).clip(1)
            below, above = lined[after - 1], lined[after]
            nearest = np.where(ends[own, axis] - below < above - ends[own, axis], below, above)
            there = surface.points(*(nearest[:, None] + 0.0 * u, v) if axis == 0 else (u, nearest[:, None] + 0.0 * v))
            along |= (word == "parameter") & (np.abs(geo.placed(shapes.view, there) - image) <= slack).all(axis=(1, 2))
        for plane in geo.planes_in(shapes.view, shapes.items[item]["planes"]):
            away = np.abs((image * plane[:3]).sum(axis=-1) + plane[3])
            along |= (word == "section") & (away <= slack).all(axis=1)
        lit = np.flatnonzero(word == "isophote")
        proved, refuted = isophotes(surface, shapes.items[item]["isophotes"], ends[own[lit]], shapes.view, slack)
        along[lit], doubt[own[lit]] = ~refuted, ~proved
        right[own] = close & along & inside.all(axis=1) & np.isfinite(start[own] + end[own]).all(axis=1)
    for share, at, tip in ((parts.low, start, 0.0), (parts.high, end, 1.0)):
        way = at - lines.at(parts.line, share)
        right &= (np.hypot(*way.T[:2]) <= slack) & ((share != tip) | (np.abs(way[:, 2]) <= DEEP * slack))
    order = np.lexsort((parts.low, parts.line))
    order = order[right[order]]
    pieces = geo.Segments(start, end, lines.owner[parts.line], np.full(len(kept), slack))
    return geo.take(pieces, order), geo.take(parts, order), doubt[order]


def cosines(
    patch: formulas.Patch, light: geo.Floats, cells: geo.Floats
) -> tuple[formulas.Range, formulas.Range, formulas.Range]:
    """Cosines of the angle between the normal, along x_u times x_v, and the way to the light, x, y, z, 0 or 1: a
    direction or a point, on cells, and their derivatives by u and v."""
    one, zero = (
        formulas.Range(np.ones(len(cells)), np.ones(len(cells))),
        formulas.Range(np.zeros(len(cells)), np.zeros(len(cells))),
    )
    place = patch.jets(np.eye(4), cells)
    u, v, uu, uv, vv = (
        [part or zero for part in of] for of in zip(*((*c.slopes, *c.bends) for c in place), strict=True)
    )

    def cross(a: list[formulas.Range], b: list[formulas.Range]) -> list[formulas.Range]:
        turned = ((a[k - 2] * b[k - 1], a[k - 1] * b[k - 2] * -1.0) for k in range(3))
        return [first + second for first, second in turned]

    def dot(a: list[formulas.Range], b: list[formulas.Range]) -> formulas.Range:
        x, y, z = (one * two for one, two in zip(a, b, strict=True))
        return x + y + z

    normal = cross(u, v)
    turns = [[p + q for p, q in zip(cross(one, v), cross(u, two), strict=True)] for one, two in ((uu, uv), (uv, vv))]
    far = [one * c + part.value * -float(light[3]) for c, part in zip(light[:3].tolist(), place, strict=True)]
    over = (dot(normal, normal) * dot(far, far)).through(np.sqrt).power(-1)
    value = dot(normal, far) * over
    found = []
    for turn, way in zip(turns, (u, v), strict=True):
        moved = [part * -float(light[3]) for part in way]
        change = dot(normal, turn) * dot(normal, normal).power(-1) + dot(far, moved) * dot(far, far).power(-1)
        found.append((dot(turn, far) + dot(normal, moved)) * over + value * change * -1.0)
    return value, found[0], found[1]


def isophotes(
    surface: formulas.Patch, lights: Any, ends: geo.Floats, view: geo.Floats, reach: float
) -> tuple[geo.Bools, geo.Bools]:
    """(n,) which pieces on a surface, u and v at both ends (n,4), have an isophote within a reach on the page all
    along, and which have none there. lights: rows x, y, z, 0 or 1, and a cosine: directions to the light, or points.

    An isophote runs between two copies of a piece, one to each side, if the cosine is larger all along the one, and
    smaller all along the other."""
    table, refuted, proved = stacked([lights], 5)[0], *np.zeros((2, len(ends)), dtype=np.bool_)
    if not len(table) or not len(ends) or (table[:, :4] != table[0, :4]).any():
        return proved, ~refuted
    of, pieces = np.arange(len(ends)), ends
    for number in range(ROUNDS):
        if number and len(pieces) > formulas.CHUNK:
            break
        joints = (
            pieces[:, None, :2] + np.linspace(0.0, 1.0, SHARES + 1)[:, None] * (pieces[:, 2:] - pieces[:, :2])[:, None]
        )
        pieces, of = np.concatenate([joints[:, :-1], joints[:, 1:]], axis=2).reshape(-1, 4), np.repeat(of, SHARES)
        good, none = isophote_beside(surface, table[0, :4], table[:, 4], pieces, view, reach)
        refuted[of[none]] = True
        open_ = ~good & ~refuted[of]
        of, pieces = of[open_], pieces[open_]
    proved[np.setdiff1d(np.arange(len(ends)), of)] = True
    return proved & ~refuted, refuted


def isophote_beside(
    surface: formulas.Patch, light: geo.Floats, levels: geo.Floats, pieces: geo.Floats, view: geo.Floats, reach: float
) -> tuple[geo.Bools, geo.Bools]:
    """(n,) see isophotes, of pieces that may be too long to tell; of those with cosines levels (k,)."""
    middle, way = 0.5 * (pieces[:, :2] + pieces[:, 2:]), pieces[:, 2:] - pieces[:, :2]
    at, by_u, by_v = cosines(surface, light, np.repeat(middle, 2, axis=1))
    level = levels[np.abs(np.subtract.outer(0.5 * (at.low + at.high), levels)).argmin(axis=1)]
    page, size = formulas.steps(surface, view, np.repeat(middle, 2, axis=1))
    across = np.stack([0.5 * (one.low + one.high) for one in (by_u, by_v)], axis=1) / np.maximum(size, geo.LEAST) ** 2
    along, far = 0.5 * np.abs(way), (page * np.abs(across)).sum(axis=1)
    # Beside contours a way on the page is a long one on the surface.
    wide = across * (2.0 * reach / np.maximum(far, geo.LEAST))[:, None]
    change = cosines(surface, light, around(middle, along + np.abs(wide)))[1:]
    most = sum(one.size * step for one, step in zip(change, (along + np.abs(wide)).T, strict=True))
    across *= (0.7 * reach / np.maximum(np.maximum(far, (size * np.abs(across)).sum(axis=1) / STEEP), geo.LEAST))[
        :, None
    ]
    cells = around(middle, along + np.abs(across))
    _, by_u, by_v = cosines(surface, light, cells)
    turn = 0.5 * (by_u * way[:, 0] + by_v * way[:, 1]).size
    less, more = (cosines(surface, light, np.repeat(middle + side * across, 2, axis=1))[0] for side in (-1.0, 1.0))
    good = (formulas.steps(surface, view, cells)[0] * np.abs(across)).sum(axis=1) <= reach
    good &= (more.low - turn > level) & (less.high + turn < level)
    return good, np.maximum(at.low - level, level - at.high) > most


def around(middle: geo.Floats, half: geo.Floats) -> geo.Floats:
    """(n,4) cells about places (n,2), half as large as (n,2)."""
    return np.stack([middle - half, middle + half], axis=2).reshape(-1, 4)


def limits_of(certificate: Any) -> Limits:
    """What is left open. Errors: ValueError where that is nothing, no number, or much of the page."""
    keys = ("width_mm", "size_mm", "smooth_mm", "crease_angle_deg")
    width, size, fine, angle = (float(certificate[key]) for key in keys)
    gap, window = certificate["hidden_gap_mm"], stacked([certificate["window_mm"]], 2)[0]
    if window.shape != (2, 2) or not (window[0] < window[1]).all():
        raise ValueError("the window is empty")
    most = WIDEST * float(np.hypot(*(window[1] - window[0])))
    if not (0.0 < width <= size <= most and 0.0 < fine <= most and 0.0 <= angle <= 180.0):
        raise ValueError("what is left open is no length, or much of the page")
    if gap is not None and not 0.0 <= gap < np.inf:
        raise ValueError("the gap of dashes is no length")
    return Limits(width, size, fine, angle, gap, window)


def shapes_of(certificate: Any) -> Shapes:
    """The shapes in the image. Errors: ValueError, KeyError, TypeError or IndexError for what is no certificate."""
    items, limits = certificate["items"], limits_of(certificate)
    (world, vertices), (corners, faces) = (stacked([one[key] for one in items], 3) for key in ("vertices", "triangles"))
    # Items of the same name are one.
    names: dict[str, int] = {}
    of_name = [names.setdefault(str(one["name"]), number) for number, one in enumerate(items)]
    item = np.repeat(np.arange(len(items)), faces)
    triangles, patch = corners.astype(np.intp), np.full(len(corners), -1)
    if ((triangles < 0) | (triangles >= vertices[item][:, None])).any():
        raise ValueError("a triangle has a vertex that there is not")
    triangles += (np.cumsum(vertices) - vertices)[item][:, None]
    patches = [(number, formulas.patch_of(row)) for number, one in enumerate(items) for row in one["surfaces"]]
    for which, (owner, surface) in enumerate(patches):
        points, more = formulas.net_of(surface)
        triangles, world = np.concatenate([triangles, more + len(world)]), np.concatenate([world, points])
        item, patch = (np.append(one, np.full(len(more), k)) for one, k in ((item, owner), (patch, which)))
    if len(triangles) > 4 * formulas.MOST_CELLS:
        raise ValueError("the nets have too many cells")
    view = geo.image_rows(stacked([certificate["page_from_world"]], 4)[0], world)
    image, off = geo.image_of(view, world)
    if patches:
        same = geo.welded(image)[triangles]
        kept = (patch < 0) | (same != np.roll(same, 1, axis=1)).all(axis=1)
        triangles, item, patch = np.where(patch[:, None] < 0, triangles, same)[kept], item[kept], patch[kept]
    nets, cells, coarse = np.zeros(len(patch)), [np.zeros((0, 9))], list[str]()
    for number, (owner, surface) in enumerate(patches):
        name = items[owner]["name"]
        off_net = float(formulas.deviations(surface, view, surface.grid()).sum(axis=1).max())
        found, every = formulas.contour_cells(surface, view, limits.fine)
        nets[patch == number] = off_net
        cells.append(found)
        good = off_net <= OFF * limits.fine
        coarse += [f"what {name} shows and hides: its net may be {off_net:.2g} mm off"] * (not good)
        coarse += [f"that contours of {name} are complete: too many cells"] * (not every)
    ends, at, may, must, outline = geo.edges_of(world, image, triangles, limits.angle, 0.01 * limits.width, patch)
    # Edges of one surface count together.
    places, slack = np.where(patch[at] < 0, np.arange(len(ends)), len(ends) + patch[at]), np.zeros(len(patch))
    slack += limits.fine if patches else limits.width
    sides = geo.Segments(image[ends[:, 0]], image[ends[:, 1]], places, slack[at])
    has = {word: np.array([word in one["lines"] for one in items], dtype=np.bool_) for word in EDGE_KINDS}
    wanted = np.logical_or.reduce([must[word] & has[word][item[at]] for word in EDGE_KINDS])
    wanted &= sides.length > 4.0 * limits.width
    spots, hides = image[triangles], np.array([one["hides"] for one in items], dtype=np.bool_)[item]
    area = np.abs(np.cross(spots[:, 1] - spots[:, 0], spots[:, 2] - spots[:, 0])[:, 2])
    broad = area > 0.02 * limits.width * np.ptp(spots[..., :2], axis=1).max(axis=1, initial=0.0)
    of = geo.Triangles(spots, geo.halves_of(spots), outline, np.flatnonzero(hides & broad), nets, slack)
    owners = np.repeat([owner for owner, _ in patches], [len(one) for one in cells[1:]]).astype(np.intp)
    number_of, bare = np.array(of_name, dtype=np.intp), [one for one in items if one["smooth"] and not one["surfaces"]]
    return Shapes(
        *(limits, view, items, names, [(of_name[owner], surface) for owner, surface in patches], sides, ends),
        *(number_of[item[at]], may, np.flatnonzero(wanted), of, number_of[item], np.concatenate(cells)),
        *(number_of[owners], has["contour"][owners], off, any(one["hides"] for one in bare), coarse),
    )


def model_of(drawing: Any, certificate: Any, shapes: Shapes) -> Model:
    """The strokes in the image of some shapes. Errors: see shapes_of."""
    rows, limits = drawing["strokes"], shapes.limits
    if any(not isinstance(row["closed"], bool) for row in rows):
        raise ValueError("a stroke is neither open nor closed")
    # A closed stroke ends in its first point.
    ways = ([[*row[key], *row[key][: row["closed"]]] for row in rows] for key in ("points", "points3d"))
    (page, many), (space, again) = (stacked(list(way), size) for way, size in zip(ways, (2, 3), strict=True))
    if not np.array_equal(many, again) or not many.all():
        raise ValueError("points and points3d of a stroke differ")
    points, off = geo.image_of(shapes.view, space)
    stroke = np.repeat(np.arange(len(rows)), many)
    begin = np.flatnonzero(stroke[:-1] == stroke[1:])
    slack = np.full(len(begin), limits.fine if shapes.patches else limits.width)
    strokes = geo.Segments(points[begin], points[begin + 1], stroke[begin], slack)
    kind, hidden = (np.array([row[key] for row in rows]) for key in ("kind", "hidden_by"))
    item = np.array([shapes.names.get(row["item"], -1) for row in rows], dtype=np.intp)
    smooth, certified = (
        {shapes.names[one["name"]] for one in shapes.items if one[key]} for key in ("smooth", "surfaces")
    )
    on, of_kind = np.isin(item, list(certified)), np.isin(kind, [*shapes.may, *FACE_KINDS])
    of_kind &= ~np.isin(item, list(smooth - certified))
    lifted = on[strokes.owner]
    pieces, told, doubt = on_surfaces(strokes, certificate["on_surfaces"], kind, item, shapes)
    bare = geo.gaps(told, strokes.least(limits.ratio))
    bare = geo.take(bare, (lifted & of_kind[strokes.owner])[bare.line])
    own = geo.together(geo.take(strokes, ~lifted), pieces)
    order = np.argsort(own.owner, kind="stable")
    own, doubt = geo.take(own, order), np.append(np.zeros(int((~lifted).sum()), dtype=np.bool_), doubt)[order]
    shift = np.asarray(np.hypot(*(page - points[:, :2]).T))
    return Model(own, strokes, bare, on, of_kind[own.owner], doubt, kind, hidden > 0, item, shift, off)
