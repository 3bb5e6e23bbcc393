"""All sweeps, in the order of the page that shows them."""

from __future__ import annotations

from sweeps import curved, meshes, scenes, verbs
from sweeps.sweep import Sweep

SWEEPS: tuple[Sweep, ...] = (*meshes.SWEEPS, *curved.SWEEPS, *scenes.SWEEPS, *verbs.SWEEPS)
