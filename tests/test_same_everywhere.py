"""The same bytes on every processor: what the package must not call, and pictures made as on other processors."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys

import pytest
from support.effort import several
from support.paths import PACKAGE, ROOT
from support.sources import text_of, tree_of

BY_PROCESSOR = {
    "dot", "vdot", "inner", "matmul", "tensordot", "cov", "corrcoef", "roots", "convolve", "correlate",
    "tan", "exp", "exp2", "expm1", "log", "log1p", "arctan", "arctan2", "arcsin", "arccos", "sinh", "cosh", "tanh",
    "arcsinh", "arccosh", "arctanh", "cbrt", "power", "float_power", "logspace", "geomspace",
}  # fmt: skip
"""Functions of numpy that BLAS, or other instructions, compute with other last bits."""

OF_LAPACK = {"det", "solve", "inv", "pinv", "svd", "eig", "eigh", "eigvals", "eigvalsh", "lstsq", "qr", "slogdet"}

OF_COMPLEX = {"geometry/elementary.py", "surfaces/minimal.py", "io/expressions.py"}
"""Files that call some of them with complex numbers, which the mathematical library computes."""

REPORTS = {
    *("speed/results.py", "accuracy/results.py", "accuracy/of_visibility.py"),
    *("testing/check_certificate.py", "testing/certified_drawing.py"),
    *("testing/certified_image.py", "testing/certified_surfaces.py"),
}
"""Files that measure times and errors, not pictures; and the checker of certificates, which imports nothing of ours and
leaves angles within a thousandth of a degree open."""

NEWER_INSTRUCTIONS = "X86_V3,X86_V4,AVX512_ICL,AVX2,FMA3,AVX512F,AVX512CD,AVX512_SKX"

WHOLE_NUMBERS = re.compile(r"np\.intp|65536|_POWERS|one @ one")
"""Products of whole numbers are exact."""


def by_processor(file: str) -> list[str]:
    """The lines of a file that another processor may round otherwise."""
    text = text_of(PACKAGE / file).splitlines()
    found = []
    for node in ast.walk(tree_of(PACKAGE / file)):
        if isinstance(node, ast.BinOp | ast.AugAssign) and isinstance(node.op, ast.MatMult):
            wrong = not WHOLE_NUMBERS.search(text[node.lineno - 1])
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "np":
            wrong = node.attr in BY_PROCESSOR and file not in OF_COMPLEX
        elif isinstance(node, ast.Call):
            name, given = ast.unparse(node.func), {keyword.arg for keyword in node.keywords}
            # Equal keys come in another order where numbers are sorted with other instructions.
            wrong = (name == "np.argsort" and "kind" not in given) or (name == "np.linalg.norm" and "axis" not in given)
            wrong = wrong or name in {f"np.linalg.{other}" for other in OF_LAPACK}
        else:
            continue
        if wrong:
            found.append(f"{file}:{node.lineno}")
    return found


def test_nothing_is_computed_by_what_the_processor_chooses():
    files = [path.relative_to(PACKAGE).as_posix() for path in sorted(PACKAGE.rglob("*.py"))]
    assert len(files) > 100
    found = [line for file in files if file not in REPORTS for line in by_processor(file)]
    assert not found, "use vectorplot/geometry/algebra.py, elementary.py, or a stable order: " + ", ".join(found)


def pictures(scenes: list[str], **environment: str) -> str:
    """Digests of scenes in all verbs and formats, made in a process of their own."""
    script = (
        "import sys, tempfile, pathlib, warnings; warnings.simplefilter('ignore')\n"
        "from support.frozen import ROOT, of_scene\n"
        "with tempfile.TemporaryDirectory() as desk:\n"
        "    for name in sys.argv[1:]:\n"
        "        print(*of_scene(ROOT / 'data' / f'{name}.scene', pathlib.Path(desk)), sep='\\n')\n"
    )
    paths = os.pathsep.join([str(ROOT / "tests"), str(ROOT), os.environ.get("PYTHONPATH", "")])
    run = subprocess.run(
        [sys.executable, "-c", script, *scenes],
        capture_output=True, text=True, check=True, env={**os.environ, "PYTHONPATH": paths, **environment},
    )  # fmt: skip
    return run.stdout


@pytest.mark.slow
@pytest.mark.hard(57)
def test_other_processors_make_the_same_bytes():
    """A spline surface, complex numbers, mirrors and patterns; tests/support/frozen.py does it for all scenes."""
    scenes = ["asymptotic_lines", "mirror", "splines"]
    here = pictures(scenes, OPENBLAS_CORETYPE="Haswell")
    assert here.count("\n") == 36
    # Zen multiplies as Haswell does.
    for core in ("Prescott", "SkylakeX")[: several(1, long=2)]:
        # The least of them without what numpy knows of newer instructions, by its names of today and of version 2.0.
        without = {"NPY_DISABLE_CPU_FEATURES": NEWER_INSTRUCTIONS} if core == "Prescott" else {}
        assert pictures(scenes, OPENBLAS_CORETYPE=core, **without) == here, core
