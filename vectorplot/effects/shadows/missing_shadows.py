"""Telling which shadows a picture lacks."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.errors import InputWarning
from vectorplot.geometry.budget import unresolved
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light


def tell_missing_shadows(items: Sequence[Item], lights: Sequence[Light], left_out: Ints) -> None:
    """Warn of shadows that are left out, with one InputWarning for each item that throws them and one on which.

    left_out (3,k): as of Cast.
    """
    for one, other in np.unique(left_out[1:], axis=1).T.tolist():
        number = left_out[0, (left_out[1] == one) & (left_out[2] == other)]
        of = ", ".join(lights[k].name or f"light {k + 1}" for k in number.tolist())
        on = "itself" if one == other else items[other].name
        text = unresolved(f"more shadows on {on} than can be cut out are left out, in {of}; the verb render has them")
        warnings.warn(f"{items[one].name}: {text}", InputWarning, stacklevel=2)
