"""Where the parts of the repository are."""

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "vectorplot"
TESTS = ROOT / "tests"
DATA = ROOT / "data"
DOCS = ROOT / "docs"
EXAMPLES = ROOT / "examples"
MODELS = Path(os.environ.get("VECTORPLOT_MODELS", ROOT.parent / "shared" / "models"))
"""Four large meshes that are not part of the repository; tests that measure on them skip without them."""
