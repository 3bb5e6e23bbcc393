"""Every run of every curve on a torus is drawn, and no other: against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from support.effort import several
from support.smooth_scenes import COSINES, LIGHT, lit, ring, views
from support.smooth_seen import chords_seen
from support.torus_runs import Run, TorusCurve, contour_of, drawn_runs, isophotes_of, parameter_lines, runs_of

from vectorplot.geometry.camera import Camera
from vectorplot.surfaces.tori import Torus

TOLERANCE = 5e-5
"""Of the chords, as a part of half the scene's extent; what is no longer need not be drawn."""

DIRECTIONS = several(4, long=400)
"""Each view has twenty curves and about eighty runs, whose ends are all compared: a few show events of each sort."""


def length_between(torus: Torus, camera: Camera, curve: TorusCurve, a: float, b: float) -> float:
    """Length of the image of a piece of a curve, as a part of half the extent of the torus."""
    points = torus.points(*curve.parameters(np.linspace(a, a + (b - a + 0.5) % 1.0 - 0.5, 9)))
    at = (points - np.asarray(camera.target)) @ camera.axes.T
    if not camera.parallel:
        at = at * (camera.distance / (camera.distance - at[:, 2:]))
    return float(np.linalg.norm(np.diff(at[:, :2], axis=0), axis=1).sum()) / (torus.major + torus.minor)


def faults_of(torus: Torus, camera: Camera, curve: TorusCurve, drawn, true: list[Run]) -> list[str]:
    """In words, what is wrong with the runs of a curve."""
    found = []
    if abs(drawn.whole - 1.0) > 1e-7:
        found.append(f"visible and hidden parts are {drawn.whole:.9f} of the whole")
    for visible, got in ((True, drawn.visible), (False, drawn.hidden)):
        runs = [run for run in true if run.visible == visible]
        if len(got) != len(runs):
            found.append(f"{len(got)} {'visible' if visible else 'hidden'} runs for {len(runs)}: {got} for {runs}")
        elif len(true) > 1:
            for run in runs:
                ends = [
                    max(
                        length_between(torus, camera, curve, run.start, a),
                        length_between(torus, camera, curve, run.end, b),
                    )
                    for a, b in got
                ]
                if min(ends) > 4.0 * TOLERANCE:
                    found.append(f"{run} ends {min(ends):.2g} elsewhere: {got}")
    return [f"{curve.name}: {fault}" for fault in found]


def without_specks(runs: list[Run], size: float) -> list[Run]:
    """The runs, those too short to be drawn added to their neighbours."""
    while len(runs) > 1 and min(run.length for run in runs) < size:
        k = min(range(len(runs)), key=lambda i: runs[i].length)
        before, after = runs[k - 1], runs[(k + 1) % len(runs)]
        if len(runs) == 2:
            return [Run(0.0, 1.0, before.visible, before.length)]
        end = after.end if after.end > before.start else after.end + 1.0
        merged = Run(before.start, end, before.visible, before.length + after.length)
        kept = [run for run in runs if run is not before and run is not after and run is not runs[k]]
        runs = sorted([*kept, merged])
    return runs


@pytest.mark.slow
@pytest.mark.parametrize("part", range(4))
def test_as_many_runs_as_in_closed_form_from_all_directions(part: int) -> None:
    torus, count = Torus(3.0, 1.0), 0
    scene = lit(ring(3.0, 1.0, 8, 6, COSINES[1::3]))
    lines = [*parameter_lines(8, 6), *isophotes_of(np.array(LIGHT), COSINES[1::3])]
    cameras = list(views(scene, DIRECTIONS, seed=1))[part::4]
    for camera in cameras:
        # Closed forms of the contour from an eye beside the ring would need other parameters.
        beside = not camera.parallel and abs(camera.eye[2]) <= torus.minor
        curves = lines if beside else [*lines, *contour_of(torus, camera)]
        seen = chords_seen(scene, camera, tolerance=TOLERANCE)
        drawn, lost = drawn_runs(torus, curves, seen.start, seen.end, seen.kind, seen.hidden_by > 0)
        assert beside or lost == 0, f"{lost} chords are on no curve of the torus, {camera}"
        for curve, got in zip(curves, drawn, strict=True):
            true = without_specks(runs_of(torus, camera, curve), 2.0 * TOLERANCE * 4.0)
            faults = faults_of(torus, camera, curve, got, true)
            assert not faults, f"{faults[0]}, {camera}"
            count += sum(run.visible for run in true)
    assert count > 13 * len(cameras)
