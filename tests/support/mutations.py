"""Drawings with one stroke that is not what it should be: ``python mutations.py 1000`` counts how many are caught."""

import copy
import json
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.backends.json import json_bytes
from vectorplot.testing import certificate
from vectorplot.testing.certificates import strokes_claimed
from vectorplot.testing.certified_drawing import EDGE_KINDS, model_of, shapes_of
from vectorplot.testing.check_certificate import (
    check,
    check_contours,
    check_missing,
    check_places,
    check_sight,
    judged,
)

LEAST_MM = 0.05
"""No mutation is smaller: five times what certificates leave open."""

DASH_MM = 3.5
"""Dashes are shorter; between them holes of twice the gap are allowed."""

SCENES = (
    *(
        "box",
        "cubes",
        "face_looks",
        "interpenetrating",
        "intersections",
        "mirror",
        "patterns",
        "pencil",
        "plate",
    ),
    *("removed_faces", "shadows", "table", "three_bars", "town", "translational_sweep", "tube"),
)
"""Scenes of data/ that consist of meshes."""

SMOOTH = ("asymptotic_lines", "capped", "house", "mixed", "ruled", "slices", "torus")
"""Those with balls, rods, cones, rings and other surfaces by formulas."""

SMOOTH_SCALE = 16.0
"""Mutations of their drawings are so many times larger."""

UNPROVED = ("integral",)
"""Kinds of strokes on surfaces whose place along these is not proved."""

SMOOTH_PAGE = "80x60"
"""On a small page there is less to prove."""


def on_page(drawing, points):
    """(n,2) the image in mm of points in the world."""
    matrix = np.array(drawing["page_from_world"])
    found = (np.asarray(points)[:, None, :] * matrix[None, :, :3]).sum(axis=2) + matrix[:, 3]
    return found[:, :2] / found[:, 3:]


def way(stroke, key):
    """The points of a stroke, the first one again at the end of a closed one."""
    return np.array([*stroke[key], *stroke[key][: stroke["closed"]]])


def length(stroke):
    """In mm."""
    return float(np.linalg.norm(np.diff(way(stroke, "points"), axis=0), axis=1).sum())


def least(drawing):
    """No mutation of a drawing is smaller, in mm: larger where surfaces are certified."""
    return LEAST_MM * drawing.get("scale", 1.0)


def some(rng, drawing, wanted):
    """The number of a stroke that is wanted and long enough to be seen; None where there is none."""
    found = [
        k for k, stroke in enumerate(drawing["strokes"]) if wanted(stroke) and length(stroke) > 4.0 * least(drawing)
    ]
    return int(rng.choice(found)) if found else None


def moved(rng, drawing):
    """A stroke elsewhere, on the page alone or in space."""
    stroke = drawing["strokes"][some(rng, drawing, lambda stroke: stroke["kind"] not in drawing.get("unproved", ()))]
    turn = rng.uniform(0.0, 2.0 * np.pi)
    step = least(drawing) * 100.0 ** rng.uniform() * np.array([np.cos(turn), np.sin(turn)])
    if rng.uniform() < 0.5:
        stroke["points"] = (np.array(stroke["points"]) + step).tolist()
        return True
    matrix, points = np.array(drawing["page_from_world"]), np.array(stroke["points3d"])
    depth = (matrix[3, :3] * points[0]).sum() + matrix[3, 3]
    slopes = (matrix[:2, :3] - on_page(drawing, points[:1]).T * matrix[3, :3]) / depth
    stroke["points3d"] = (points + np.linalg.lstsq(slopes, step, rcond=None)[0]).tolist()
    stroke["points"] = on_page(drawing, stroke["points3d"]).tolist()
    return True


def dropped(rng, drawing):
    """A contour, crease or border less."""
    number = some(
        rng, drawing, lambda one: one["kind"] in EDGE_KINDS and (one["hidden_by"] == 0 or length(one) > DASH_MM)
    )
    stroke = drawing["strokes"].pop(number)
    return not shown_by_others(drawing, way(stroke, "points"))


def added(rng, drawing):
    """A stroke more, from somewhere between two points to somewhere else there, or twice the same one."""
    one, two = (drawing["strokes"][k] for k in rng.integers(len(drawing["strokes"]), size=2))
    if rng.uniform() < 0.1:
        drawing["strokes"].append(
            copy.deepcopy(drawing["strokes"][some(rng, drawing, lambda stroke: stroke["kind"] in EDGE_KINDS)])
        )
        return True
    ends = np.array([rng.choice(one["points3d"]), rng.choice(two["points3d"])])
    share = rng.uniform(0.05, 0.45)
    points = np.array([ends[0] + share * (ends[1] - ends[0]), ends[1] + share * (ends[0] - ends[1])])
    page = on_page(drawing, points)
    kind = {
        "kind": str(rng.choice(EDGE_KINDS)),
        "item": one["item"],
        "hidden_by": int(rng.integers(2)),
        "closed": False,
    }
    place = int(rng.integers(len(drawing["strokes"]) + 1))
    drawing["strokes"].insert(place, {**kind, "points": page.tolist(), "points3d": points.tolist()})
    return float(np.linalg.norm(page[1] - page[0])) > 2.0 * least(drawing)


def shortened(rng, drawing):
    """A visible contour, crease or border that ends too early."""
    visible = some(rng, drawing, lambda stroke: stroke["kind"] in EDGE_KINDS and stroke["hidden_by"] == 0)
    stroke = drawing["strokes"][visible]
    points = way(stroke, "points3d")[:: int(rng.choice([1, -1]))].copy()
    page = on_page(drawing, points)
    last = float(np.linalg.norm(page[-1] - page[-2]))
    if last < 2.0 * least(drawing):
        return False
    cut, low, high, end = rng.uniform(least(drawing), 0.9 * last), 0.0, 1.0, points[-1]
    for _ in range(50):
        share = 0.5 * (low + high)
        end = points[-1] + share * (points[-2] - points[-1])
        near = np.linalg.norm(on_page(drawing, end[None])[0] - page[-1]) < cut
        low, high = (share, high) if near else (low, share)
    points[-1] = end
    stroke.update(points3d=points.tolist(), points=on_page(drawing, points).tolist(), closed=False)
    return not shown_by_others(drawing, np.array([page[-1], on_page(drawing, end[None])[0]]))


def shown(rng, drawing):
    """A hidden stroke among the visible ones."""
    number = some(rng, drawing, lambda stroke: stroke["hidden_by"] > 0)
    if number is None:
        return False
    drawing["strokes"][number]["hidden_by"] = 0
    return True


def hidden(rng, drawing):
    """A visible stroke among the hidden ones."""
    drawing["strokes"][some(rng, drawing, lambda stroke: stroke["hidden_by"] == 0)]["hidden_by"] = 1
    return True


MUTATIONS = (moved, dropped, added, shortened, shown, hidden)


def shown_by_others(drawing, points):
    """Whether other strokes run where a way (n,2) did, but for 2 micrometres: then it is still drawn."""
    ways = [way(stroke, "points") for stroke in drawing["strokes"] if len(stroke["points"]) > 1]
    start, end = (np.concatenate([one[part] for one in ways]) for part in (slice(None, -1), slice(1, None)))
    along = end - start
    middle = 0.5 * (points[:-1] + points[1:])[:, None]
    share = ((middle - start) * along).sum(axis=2) / np.maximum((along * along).sum(axis=1), 1e-30)
    off = np.linalg.norm(middle - start - np.clip(share, 0.0, 1.0)[..., None] * along, axis=2).min(axis=1)
    return bool((off < (0.1 if "scale" in drawing else 0.002)).all())


def mutated(rng, drawing, mutation):
    """A drawing, as in a file, with one mutation that shows; None where it has nothing to mutate in so many tries."""
    for _ in range(20):
        # Mutations replace what stands in a stroke.
        other = {**drawing, "strokes": [dict(stroke) for stroke in drawing["strokes"]]}
        if mutation(rng, other):
            return other
    return None


def plain(drawing):
    """A drawing as in its file, without what is said of it here."""
    return {key: value for key, value in drawing.items() if key not in ("scale", "unproved")}


def certified(scene, drawing, how):
    """A drawing as it is read again, in which strokes may stand in another order, and its certificate, as in files."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "drawing.json"
        path.write_text(json.dumps(plain(drawing)))
        read = vp.read(path)
    made = certificate(scene, read, hidden=how, page=SMOOTH_PAGE if "scale" in drawing else None)
    return json.loads(json_bytes(read)), made.content


def faults(scene, drawing, how):
    """What is wrong with a drawing, as in a file, by a certificate of its own."""
    return check(*certified(scene, drawing, how))[0]


AROUND_MM = 3.0
"""Strokes that are farther from a line do not count as this line."""


class Proof:
    """A right drawing, as in a file, and its certificate; mutations of it share the shapes.

    A stroke is where it should be, and visible, or not, whatever the others are; and whether a line is missing depends
    on the strokes beside it. So the strokes that changed are checked alone, and then the lines where some are gone. A
    fault that is found in this way is one of the whole drawing. Where none is found the whole is checked.
    """

    def __init__(self, scene, drawing, how):
        self.scene, self.how = scene, how
        read, self.content = certified(scene, drawing, how)
        self.drawing = {**drawing, **read}
        assert not check(read, self.content)[0]
        self.shapes = shapes_of(self.content)
        self.number = {json.dumps(stroke): number for number, stroke in enumerate(drawing["strokes"])}

    def faults(self, other):
        """What is wrong with a mutated drawing."""
        texts = [json.dumps(stroke) for stroke in other["strokes"]]
        times = Counter(texts)
        twice = [one for one, text in zip(other["strokes"], texts, strict=True) if times[text] > 1]
        gone = [one for text, one in zip(self.number, self.drawing["strokes"], strict=True) if text not in times]
        return (
            self._alone(self.changed(other) + twice)
            or self._missing(other, texts, gone)
            or faults(self.scene, other, self.how)
        )

    def changed(self, other):
        """The strokes of a mutated drawing that the right one has not."""
        return [stroke for stroke in other["strokes"] if json.dumps(stroke) not in self.number]

    def _alone(self, strokes):
        """What is wrong with some strokes."""
        few = {**plain(self.drawing), "strokes": strokes}
        claims = {**self.content, **strokes_claimed(few, self.content, self.shapes)}
        model = model_of(few, claims, self.shapes)
        if (model.shift > self.content["width_mm"]).any():
            return ["off their places in space"]
        return judged(model, claims, self.shapes, (check_places, check_sight))[0]

    def _missing(self, other, texts, gone):
        """What is missing where some strokes were."""
        if not gone:
            return []
        places = np.concatenate([stroke["points"] for stroke in gone])
        low, high = places.min(axis=0), places.max(axis=0)
        limits = self.shapes.limits
        window = np.array([np.maximum(low, limits.window[0]), np.minimum(high, limits.window[1])])
        window += [[-0.1], [0.1]]
        near = [
            stroke
            for stroke in other["strokes"]
            if (np.max(stroke["points"], axis=0) > low - AROUND_MM).all()
            and (np.min(stroke["points"], axis=0) < high + AROUND_MM).all()
        ]
        rows = self._rows(near)
        # What counts is where they are, not whether they are what they are called.
        near = [{**stroke, "kind": "pattern"} if stroke["kind"] == "isophote" else stroke for stroke in near]
        few, shapes = (
            {**plain(self.drawing), "strokes": near},
            self.shapes._replace(limits=limits._replace(window=window)),
        )
        claims = {**self.content, "on_surfaces": rows}
        return judged(model_of(few, claims, shapes), claims, shapes, (check_missing, check_contours))[0]

    def _rows(self, strokes):
        """Where on surfaces strokes run, by their numbers among some."""
        new = {self.number.get(json.dumps(stroke), -1): number for number, stroke in enumerate(strokes)}
        rows = [[new[row[0]], *row[1:]] for row in self.content["on_surfaces"] if row[0] in new]
        changed = [number for number, stroke in enumerate(strokes) if json.dumps(stroke) not in self.number]
        few = {**plain(self.drawing), "strokes": [strokes[number] for number in changed]}
        more = strokes_claimed(few, self.content, self.shapes)["on_surfaces"] if changed else []
        return rows + [[changed[row[0]], *row[1:]] for row in more]


def drawn(names, how):
    """Scenes of data/ and their drawings as in a file; of surfaces those on which mutations are larger."""
    scenes = [vp.read(Path(__file__).parents[2] / "data" / f"{name}.scene") for name in names]
    small = [name in SMOOTH for name in names]
    pages = [SMOOTH_PAGE if one else None for one in small]
    made = [
        json.loads(json_bytes(vp.draw(scene, hidden=how, page=page, reflections=0)))
        for scene, page in zip(scenes, pages, strict=True)
    ]
    for drawing, one in zip(made, small, strict=True):
        drawing.update({"scale": SMOOTH_SCALE, "unproved": UNPROVED} if one else {})
    return list(zip(scenes, made, strict=True))


def main(many, how, seed, names):
    """Print how many of so many mutations are caught, and which are not."""
    rng, caught, missed, start = np.random.default_rng(seed), Counter(), [], time.perf_counter()
    proofs = [Proof(*pair, how) for pair in drawn(names, how)]
    print(f"{len(proofs)} drawings in {time.perf_counter() - start:.0f} s", flush=True)
    while caught.total() + len(missed) < many:
        number = int(rng.integers(len(proofs)))
        mutation = MUTATIONS[(caught.total() + len(missed)) % len(MUTATIONS)]
        other = mutated(rng, proofs[number].drawing, mutation)
        if other is None:
            continue
        if proofs[number].faults(other):
            caught[mutation.__name__] += 1
            if caught.total() % 50 == 0:
                print(caught.total(), f"caught in {time.perf_counter() - start:.0f} s", flush=True)
        else:
            missed.append((names[number], mutation.__name__))
            print("missed", missed[-1], *proofs[number].changed(other), flush=True)
    print(dict(caught), f"caught, {len(missed)} missed, in {time.perf_counter() - start:.0f} s", missed)


if __name__ == "__main__":
    many, how, seed, group = (*sys.argv[1:], *("100", "solid", "0", "meshes")[len(sys.argv) - 1 :])
    main(int(many), how, int(seed), SMOOTH if group == "surfaces" else SCENES)
