"""Solutions of the exercises of the course, and answers that are wrong: by chapter, exercise by exercise."""

import numpy as np


def frame(eye, target):
    back = (eye - target) / np.linalg.norm(eye - target)
    right = np.cross((0.0, 0.0, 1.0), back)
    right /= np.linalg.norm(right)
    return right, np.cross(back, right), back


# Chapter 1.


def parallel(points, eye, target):
    right, up, _ = frame(eye, target)
    return np.stack([(points - target) @ right, (points - target) @ up], axis=1)


def parallel_about_the_origin(points, eye, target):
    return parallel(points + target, eye, target)


def vanishing_point(direction, eye, target):
    right, up, back = frame(eye, target)
    d = np.linalg.norm(eye - target)
    return -d * np.array([direction @ right, direction @ up]) / (direction @ back)


def vanishing_point_of_the_wrong_side(direction, eye, target):
    return -vanishing_point(direction, eye, target)


def nearest_distance(points, towards_eye, fov_deg):
    _, up, back = frame(towards_eye, np.zeros(3))
    return float((points @ back + np.abs(points @ up) / np.tan(np.radians(fov_deg) / 2.0)).max())


def nearest_distance_without_depth(points, towards_eye, fov_deg):
    _, up, _ = frame(towards_eye, np.zeros(3))
    return float((np.abs(points @ up) / np.tan(np.radians(fov_deg) / 2.0)).max())


def nearest_distance_of_a_ball(points, towards_eye, fov_deg):
    return float(np.linalg.norm(points, axis=1).max() / np.sin(np.radians(fov_deg) / 2.0))


# Chapter 2.


def volumes(points, triangle, eye):
    """(4, n) heights over the three planes through the eye and a side, and over the triangle's own."""
    a, b = triangle, np.roll(triangle, -1, axis=0)
    sides = (points - eye) @ np.cross(a - eye, b - eye).T
    own = (points - triangle[0]) @ np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
    return np.vstack([sides.T, own[None]])


def hidden(points, triangle, eye):
    *sides, own = volumes(points, triangle, eye)
    inside = (np.array(sides) > 0).all(axis=0) | (np.array(sides) < 0).all(axis=0)
    return inside & (own * volumes(eye[None], triangle, eye)[3] < 0)


def hidden_one_way_round(points, triangle, eye):
    *sides, own = volumes(points, triangle, eye)
    return (np.array(sides) > 0).all(axis=0) & (own * volumes(eye[None], triangle, eye)[3] < 0)


def hidden_in_front_too(points, triangle, eye):
    sides = volumes(points, triangle, eye)[:3]
    return (sides > 0).all(axis=0) | (sides < 0).all(axis=0)


def changes(p, q, triangle, eye):
    g, h = volumes(np.array([p, q]), triangle, eye).T
    crossed = g * h < 0
    return np.sort(g[crossed] / (g[crossed] - h[crossed]))


def changes_at_sides_alone(p, q, triangle, eye):
    g, h = volumes(np.array([p, q]), triangle, eye)[:3].T
    crossed = g * h < 0
    return np.sort(g[crossed] / (g[crossed] - h[crossed]))


def visible_length(p, q, triangles, eye):
    t = np.sort(np.concatenate([[0.0, 1.0], *(changes(p, q, triangle, eye) for triangle in triangles)]))
    middle = p + ((t[1:] + t[:-1]) / 2)[:, None] * (q - p)
    unseen = np.zeros(len(middle), dtype=bool)
    for triangle in triangles:
        unseen |= hidden(middle, triangle, eye)
    return float(np.diff(t)[~unseen].sum() * np.linalg.norm(q - p))


def visible_length_by_sums(p, q, triangles, eye):
    length = np.linalg.norm(q - p)
    return float(length - sum(length - visible_length(p, q, triangle[None], eye) for triangle in triangles))


# Chapter 3.


def clipped(p, q, normals, offsets):
    g, h = normals @ p - offsets, normals @ q - offsets
    if ((g > 0) & (h > 0)).any():
        return None
    with np.errstate(all="ignore"):
        t = g / (g - h)
    begin, end = t[(g > 0) & (h <= 0)].max(initial=0.0), t[(g <= 0) & (h > 0)].min(initial=1.0)
    return (float(begin), float(end)) if begin <= end else None


def clipped_without_parallels(p, q, normals, offsets):
    g, h = normals @ p - offsets, normals @ q - offsets
    with np.errstate(all="ignore"):
        t = g / (g - h)
    begin, end = t[(g > h + 1e-9)].max(initial=0.0), t[(g < h - 1e-9)].min(initial=1.0)
    return (float(begin), float(end)) if begin <= end else None


def united(intervals):
    low, high = intervals[np.argsort(intervals[:, 0])].T
    reached = np.maximum.accumulate(high)
    begins = np.append(True, low[1:] > reached[:-1])[: len(low)]
    ends = np.append(begins[1:], True)[: len(low)]
    return np.stack([low[begins], reached[ends]], axis=1)


def united_with_the_neighbour_alone(intervals):
    low, high = intervals[np.argsort(intervals[:, 0])].T
    begins = np.append(True, low[1:] > high[:-1])[: len(low)]
    ends = np.append(begins[1:], True)[: len(low)]
    return np.stack([low[begins], high[ends]], axis=1)


def counted(intervals):
    at = np.concatenate([intervals[:, 0], intervals[:, 1]])
    step = np.repeat([1, -1], len(intervals))
    cuts = np.unique(np.concatenate([[0.0, 1.0], at]))
    counts = np.cumsum(np.bincount(np.searchsorted(cuts, at), step, len(cuts)))[:-1].astype(int)
    kept = np.append(True, np.diff(counts) != 0)
    return np.append(cuts[:-1][kept], 1.0), counts[kept]


def counted_with_empty_changes(intervals):
    at = np.concatenate([intervals[:, 0], intervals[:, 1]])
    cuts = np.unique(np.concatenate([[0.0, 1.0], at]))
    middle = (cuts[1:] + cuts[:-1]) / 2
    return cuts, ((intervals[:, :1] < middle) & (middle < intervals[:, 1:])).sum(axis=0)


# Chapter 4.


def crossings(f, a, b):
    sign = f(*a.T) > 0
    for _ in range(60):
        middle = (a + b) / 2
        same = ((f(*middle.T) > 0) == sign)[:, None]
        a, b = np.where(same, middle, a), np.where(same, b, middle)
    return (a + b) / 2


def crossings_by_one_secant(f, a, b):
    g, h = f(*a.T)[:, None], f(*b.T)[:, None]
    return a + g / (g - h) * (b - a)


def in_triangles(corners, values):
    ahead, other = np.roll(corners, -1, axis=1), np.roll(values, -1, axis=1)
    crossed = (values > 0) != (other > 0)
    part = (values[crossed] / (values[crossed] - other[crossed]))[:, None]
    return (corners[crossed] + part * (ahead[crossed] - corners[crossed])).reshape(-1, 2, 2)


def in_triangles_at_middles(corners, values):
    ahead = np.roll(corners, -1, axis=1)
    crossed = (values > 0) != (np.roll(values, -1, axis=1) > 0)
    return ((corners + ahead) / 2)[crossed].reshape(-1, 2, 2)


def branches(segments):
    if not len(segments):
        return 0, 0
    _, number = np.unique(segments.reshape(-1, 2), axis=0, return_inverse=True)
    number = number.reshape(-1, 2)
    root = np.arange(number.max() + 1)
    for _ in range(len(root)):
        least = np.minimum(root[number[:, 0]], root[number[:, 1]])
        before = root.copy()
        np.minimum.at(root, number.ravel(), np.repeat(least, 2))
        if (root == before).all():
            break
    opened = int((np.bincount(number.ravel()) == 1).sum()) // 2
    return opened, len(np.unique(root)) - opened


def branches_all_closed(segments):
    return 0, sum(branches(segments))


# Chapter 5.


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def facing(surface, u, v, eye):
    return (unit(np.cross(*surface.partials(u, v))) * unit(eye - surface.points(u, v))).sum(axis=1)


def facing_away(surface, u, v, eye):
    return -facing(surface, u, v, eye)


def facing_not_divided(surface, u, v, eye):
    return (np.cross(*surface.partials(u, v)) * (eye - surface.points(u, v))).sum(axis=1)


def contour_of_sphere(centre, radius, eye):
    d = np.linalg.norm(eye - centre)
    return centre + (radius / d) ** 2 * (eye - centre), radius * np.sqrt(1 - (radius / d) ** 2)


def contour_of_sphere_as_a_great_circle(centre, radius, eye):
    return centre, radius


def bend_towards_eye(surface, u, v, eye):
    by_u, by_v = surface.partials(u, v)
    sight, n = unit(eye - surface.points(u, v)), unit(np.cross(by_u, by_v))
    e, f, g = ((a * b).sum(axis=1) for a, b in ((by_u, by_u), (by_u, by_v), (by_v, by_v)))
    s, t = (sight * by_u).sum(axis=1), (sight * by_v).sum(axis=1)
    a, b = (g * s - f * t) / (e * g - f * f), (e * t - f * s) / (e * g - f * f)
    uu, uv, vv = ((n * second).sum(axis=1) for second in surface.second_partials(u, v))
    return uu * a * a + 2 * uv * a * b + vv * b * b


def bend_towards_eye_of_one_mixed_term(surface, u, v, eye):
    by_u, by_v = surface.partials(u, v)
    sight, n = unit(eye - surface.points(u, v)), unit(np.cross(by_u, by_v))
    a, b = ((sight * by).sum(axis=1) for by in (by_u, by_v))
    uu, uv, vv = ((n * second).sum(axis=1) for second in surface.second_partials(u, v))
    return uu * a * a + uv * a * b + vv * b * b


# Chapter 6.


def heights(face, points, eye):
    normal = np.cross(face[1] - face[0], face[2] - face[0])
    return (points - face[0]) @ normal * np.sign((eye - face[0]) @ normal)


def side(face, points, eye):
    over = heights(face, points, eye)
    return 1 if (over >= 0).all() else -1 if (over <= 0).all() else 0


def side_of_one_corner(face, points, eye):
    return 1 if heights(face, points, eye)[0] >= 0 else -1


def side_by_the_sense_of_the_face(face, points, eye):
    over = (points - face[0]) @ np.cross(face[1] - face[0], face[2] - face[0])
    return 1 if (over >= 0).all() else -1 if (over <= 0).all() else 0


def ordered(count, demands):
    order, left = [], set(range(count))
    while left:
        free = [k for k in sorted(left) if not any(a == k and b in left for b, a in demands)]
        if not free:
            return None
        order.append(free[0])
        left.remove(free[0])
    return order


def ordered_by_how_many_demands(count, demands):
    return sorted(range(count), key=lambda k: sum(a == k for _, a in demands))


def halves(face, normal, c):
    over = face @ normal - c
    parts = []
    for sign in (1, -1):
        corners = []
        for p, q, g, h in zip(face, np.roll(face, -1, axis=0), over, np.roll(over, -1), strict=True):
            corners += [p] if sign * g > 0 else []
            corners += [p + g / (g - h) * (q - p)] if g * h < 0 else []
        parts.append(np.array(corners).reshape(-1, 3))
    return tuple(parts)


def halves_without_new_corners(face, normal, c):
    over = face @ normal - c
    return face[over > 0], face[over < 0]


# Chapter 7.


def sun_shadow(points, to_sun):
    return points - points[:, 2:] / to_sun[2] * to_sun


def sun_shadow_the_wrong_way(points, to_sun):
    return points + points[:, 2:] / to_sun[2] * to_sun * (1, 1, -1)


def lamp_shadow(points, lamp, normal, c):
    over, own = lamp @ normal - c, points @ normal - c
    with np.errstate(all="ignore"):
        s = over / (over - own)
    s = np.where(np.isfinite(s) & (s > 1), s, np.nan)
    return lamp + s[:, None] * (points - lamp)


def lamp_shadow_of_all_points(points, lamp, normal, c):
    over = lamp @ normal - c
    return lamp + (over / (over - (points @ normal - c)))[:, None] * (points - lamp)


def lit(points, lamp, triangles):
    a, b, c = (triangles[:, k] for k in range(3))
    ray = (points - lamp)[:, None, :]
    rounds = np.stack([(ray * np.cross(s - lamp, t - lamp)).sum(axis=2) for s, t in ((a, b), (b, c), (c, a))])
    normal = np.cross(b - a, c - a)
    beyond = ((points[:, None] - a) * normal).sum(axis=2) * ((lamp - a) * normal).sum(axis=1) < 0
    return ~(((rounds > 0).all(axis=0) | (rounds < 0).all(axis=0)) & beyond).any(axis=1)


def lit_with_shadows_before_the_triangle(points, lamp, triangles):
    a, b, c = (triangles[:, k] for k in range(3))
    ray = (points - lamp)[:, None, :]
    rounds = np.stack([(ray * np.cross(s - lamp, t - lamp)).sum(axis=2) for s, t in ((a, b), (b, c), (c, a))])
    return ~((rounds > 0).all(axis=0) | (rounds < 0).all(axis=0)).any(axis=1)


# Chapter 8.


def frame_times(frames, loop):
    return np.arange(frames) / (frames if loop else max(frames - 1, 1))


def frame_times_to_the_end(frames, loop):
    return np.linspace(0, 1, frames)


def between_keys(times, values, t, closed):
    if closed:
        times, values = np.r_[times[-1] - 1, times, times[0] + 1], np.r_[values[-1], values, values[0]]
    return np.interp(t, times, values)


def between_keys_of_no_loop(times, values, t, closed):
    return np.interp(t, times, values)


def akima(times, values, t):
    m = np.diff(values) / np.diff(times)
    m = np.r_[3 * m[0] - 2 * m[1], 2 * m[0] - m[1], m, 2 * m[-1] - m[-2], 3 * m[-1] - 2 * m[-2]]
    before, after = np.abs(m[3:] - m[2:-1]), np.abs(m[1:-2] - m[:-3])
    both = before + after
    slope = np.where(
        both > 0,
        (before * m[1:-2] + after * m[2:-1]) / np.where(both > 0, both, 1),
        (m[1:-2] + m[2:-1]) / 2,
    )
    return hermite(times, values, slope, t)


def hermite(times, values, slope, t):
    k = np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(times) - 2)
    h = times[k + 1] - times[k]
    s = (t - times[k]) / h
    return (
        (1 + 2 * s) * (1 - s) ** 2 * values[k]
        + s * (1 - s) ** 2 * h * slope[k]
        + s**2 * (3 - 2 * s) * values[k + 1]
        + s**2 * (s - 1) * h * slope[k + 1]
    )


def akima_of_even_slopes(times, values, t):
    return hermite(times, values, np.gradient(values, times), t)


def akima_that_divides_by_nothing(times, values, t):
    m = np.diff(values) / np.diff(times)
    m = np.r_[3 * m[0] - 2 * m[1], 2 * m[0] - m[1], m, 2 * m[-1] - m[-2], 3 * m[-1] - 2 * m[-2]]
    before, after = np.abs(m[3:] - m[2:-1]), np.abs(m[1:-2] - m[:-3])
    return hermite(times, values, (before * m[1:-2] + after * m[2:-1]) / (before + after), t)


RIGHT = {
    1: (parallel, vanishing_point, nearest_distance),
    2: (hidden, changes, visible_length),
    3: (clipped, united, counted),
    4: (crossings, in_triangles, branches),
    5: (facing, contour_of_sphere, bend_towards_eye),
    6: (side, ordered, halves),
    7: (sun_shadow, lamp_shadow, lit),
    8: (frame_times, between_keys, akima),
}
"""The solutions, by chapter; named as the exercises are."""

WRONG = [
    (1, "parallel", parallel_about_the_origin, "expected"),
    (1, "vanishing_point", vanishing_point_of_the_wrong_side, "direction"),
    (1, "nearest_distance", nearest_distance_without_depth, "a point is off the page"),
    (1, "nearest_distance", nearest_distance_of_a_ball, "the eye could be nearer"),
    (2, "hidden", hidden_one_way_round, "triangle"),
    (2, "hidden", hidden_in_front_too, "triangle"),
    (2, "changes", changes_at_sides_alone, "places"),
    (2, "visible_length", visible_length_by_sums, "found"),
    (3, "clipped", clipped_without_parallels, "inside|outside"),
    (3, "united", united_with_the_neighbour_alone, "expected"),
    (3, "counted", counted_with_empty_changes, "one piece"),
    (4, "crossings", crossings_by_one_secant, "from the zero"),
    (4, "in_triangles", in_triangles_at_middles, "not 0"),
    (4, "branches", branches_all_closed, "open and closed"),
    (5, "facing", facing_away, "the sign"),
    (5, "facing", facing_not_divided, "radius"),
    (5, "contour_of_sphere", contour_of_sphere_as_a_great_circle, "do not touch"),
    (5, "bend_towards_eye", bend_towards_eye_of_one_mixed_term, "expected"),
    (6, "side", side_of_one_corner, "expected 0"),
    (6, "side", side_by_the_sense_of_the_face, "expected"),
    (6, "ordered", ordered_by_how_many_demands, "no order"),
    (6, "halves", halves_without_new_corners, "do not add up"),
    (7, "sun_shadow", sun_shadow_the_wrong_way, "ray"),
    (7, "lamp_shadow", lamp_shadow_of_all_points, "shadow or none"),
    (7, "lit", lit_with_shadows_before_the_triangle, "is lit: True"),
    (8, "frame_times", frame_times_to_the_end, "loop=True"),
    (8, "between_keys", between_keys_of_no_loop, "closed"),
    (8, "akima", akima_of_even_slopes, "off by"),
    (8, "akima", akima_that_divides_by_nothing, "divide|invalid"),
]
"""Answers that are wrong, and a part of what is said of each."""
