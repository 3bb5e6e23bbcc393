"""Rough meshes: every face turned its own way, and in its own light."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np

from vectorplot.geometry.mesh import Mesh
from vectorplot.testing.shapes import bumpy_icosphere

ROUGH = 0.5
"""By so much of the length of edges vertices are off, at most, where nothing else is said."""


def rough_sphere(halvings: int, rough: float = ROUGH) -> Mesh:
    """A bumpy sphere of 20 times 4 to the power of halvings triangles, its vertices moved in and out at random."""
    even = bumpy_icosphere(halvings)
    off = rough * 1.2 / 2**halvings * np.random.default_rng(7).uniform(-1.0, 1.0, (len(even.vertices), 1))
    return Mesh(even.vertices * (1.0 + off), even.corners, even.offsets)


VERBS = {
    "draw": "vp.draw(scene, jobs=1)",
    "hatch": "vp.draw(scene, lines='contour', hatch=vp.Hatching('tone'), jobs=1)",
    "paint": "vp.paint(scene, jobs=1)",
    "render": "vp.render(scene, size=(800, 600), jobs=1)",
}


def made_in_two_gigabytes(verb: str, halvings: int) -> int:
    """The size of the file, SVG or PNG, of a mesh of 20 * 4 ** halvings triangles under a lamp."""
    program = f"""
import resource
resource.setrlimit(resource.RLIMIT_AS, (2 * 10**9, 2 * 10**9))
import io
import vectorplot as vp
from support.rough import rough_sphere
scene = vp.Scene((vp.Item("M", rough_sphere({halvings})),), (vp.Light((9.0, -7.0, 12.0)),))
file = io.BytesIO()
vp.save({VERBS[verb]}, file, format="{"png" if verb == "render" else "svg"}")
print(len(file.getvalue()))
"""
    paths = os.pathsep.join(path for path in sys.path if path)
    told = os.environ | {"PYTHONPATH": paths, "OPENBLAS_NUM_THREADS": "1"}
    found = subprocess.run([sys.executable, "-c", program], env=told, capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stderr
    return int(found.stdout)
