"""How far pixels are off: rendered pictures against one with 64 samples a pixel.

``python pixel_errors.py`` measures all scenes of data/, ``python pixel_errors.py gallery`` those that the scripts in
examples/ draw, paint or render, and ``python pixel_errors.py within`` whether pictures of data/ keep times.
"""

import dataclasses
import importlib.util
import sys
import tempfile
import time
import warnings
from pathlib import Path
from unittest import mock

import numpy as np
from scipy.ndimage import maximum_filter, minimum_filter

import vectorplot as vp
from vectorplot.io.anything import scene_of

FINE = 8
"""Pixels of the fine picture along the side of one."""

APART = np.sqrt(2.0) / FINE
"""What a fine picture cannot tell, in pixels of the other one: edges, and samples of the other one, lie between its
pixels, each by half a diagonal at most."""

SHADES = 3.0
"""Colours that differ by no more are the same, in steps of 255: shading is interpolated."""

OUTLIERS = 5e-4
"""So many of all pixels may differ: where a fine picture itself misses what is thinner than its pixels."""


def disc(radius):
    """The pixels of the fine picture within a radius, in pixels of the other one."""
    reach = int(np.ceil(radius * FINE))
    x, y = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    return np.hypot(x, y) <= radius * FINE


def averages(fine):
    """Means over the fine pixels of each pixel."""
    rows, columns, channels = fine.shape
    return fine.reshape(rows // FINE, FINE, columns // FINE, FINE, channels).mean(axis=(1, 3))


def outside(picture, fine, radius):
    """The share of pixels that no picture can have in which everything is where it should be, but for a radius."""
    foot = disc(radius)[:, :, None]
    low, high = (
        averages(filtered(fine, footprint=foot, mode="nearest")) for filtered in (minimum_filter, maximum_filter)
    )
    return float(((picture < low - SHADES) | (picture > high + SHADES)).any(axis=2).mean())


def pixels(image):
    """(rows, columns, 3) of an image, as numbers."""
    return np.asarray(image.pixels)[..., :3].astype(float)


def error(scene, off_by, camera=None, size=(96, 72)):
    """What was said of a promise, and the least radius in pixels within which all pixels are right."""
    reports = []
    # Letters have a size in mm, and are other ones in a picture of more pixels.
    scene = dataclasses.replace(scene_of(scene), labels=())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        picture = pixels(vp.render(scene, camera, off_by=off_by, size=size, explain=reports.append))
        fine = pixels(vp.render(scene, camera, samples=1, shadows="exact", size=tuple(FINE * side for side in size)))
    said = next(one for one in reports if "promise" in one.name)
    steps = np.sqrt(sorted({a * a + b * b for a in range(2 * FINE) for b in range(2 * FINE)}))
    for radius in steps[(steps > 0.0) & (steps < 2 * FINE)] / FINE:
        if outside(picture, fine, radius) <= OUTLIERS:
            return said, max(radius - APART, 0.0)
    return said, np.inf


def of_data():
    """The scenes of data/, with their names and cameras."""
    for path in sorted((ROOT / "data").glob("*.scene")):
        yield path.stem, vp.read(path), None


def of_gallery():
    """What the scripts in examples/ draw, paint and render, each scene of a script once."""
    sys.path.append(str(ROOT / "examples"))
    for path in sorted((ROOT / "examples").glob("*.py")):
        spec, calls = importlib.util.spec_from_file_location(f"example_{path.stem}", path), []
        script = importlib.util.module_from_spec(spec)

        def noted(verb, calls=calls):
            def called(*given, **options):
                calls.append((given[0], given[1] if len(given) > 1 else options.get("camera")))
                return verb(*given, **options)

            return called

        verbs = {name: noted(getattr(vp, name)) for name in ("draw", "paint", "render")}
        with tempfile.TemporaryDirectory() as folder, mock.patch.multiple(vp, **verbs):
            spec.loader.exec_module(script)
            script.main(Path(folder))
        seen = []
        for scene, camera in calls:
            if not any(scene is one for one in seen):
                seen.append(scene)
                yield path.stem, scene, camera


ROOT = Path(__file__).parents[2]


def times():
    """Whether pictures of data/ are done in a time."""
    for name, scene, _ in of_data():
        for seconds in (0.5, 1.0, 2.0):
            start = time.perf_counter()
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                vp.render(scene, within=seconds, size=(320, 240))
            spent = time.perf_counter() - start
            print(name, seconds, "kept" if spent <= seconds else "missed", f"{spent:.2f} s", flush=True)


def main(words):
    """Print promise and measurement."""
    if words[:1] == ["within"]:
        times()
        return
    for name, scene, camera in of_gallery() if words[:1] == ["gallery"] else of_data():
        for off_by in (0.5, 0.25):
            start = time.process_time()
            try:
                said, found = error(scene, off_by, camera)
            except vp.InputError as refused:
                print(name, off_by, "refused:", refused, flush=True)
                continue
            print(name, off_by, said.name, said.why, found, f"{time.process_time() - start:.1f} s", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
