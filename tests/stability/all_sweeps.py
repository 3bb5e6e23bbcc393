"""All sweeps, in the order of the page that shows them."""

from __future__ import annotations

from stability import curved, meshes, scenes, verbs
from stability.sweep import Sweep

SWEEPS: tuple[Sweep, ...] = (*meshes.SWEEPS, *curved.SWEEPS, *scenes.SWEEPS, *verbs.SWEEPS)
