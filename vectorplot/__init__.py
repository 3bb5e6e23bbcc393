"""3-D scenes as exact line drawings.

``import vectorplot as vp`` loads nothing but this file: every name below is imported when it is first used.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vectorplot.draw import draw
    from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
    from vectorplot.errors import InputError, InputWarning
    from vectorplot.geometry.cameras.camera import Camera
    from vectorplot.geometry.mesh import Mesh
    from vectorplot.geometry.strokes import Strokes
    from vectorplot.io.read import read
    from vectorplot.paint import paint
    from vectorplot.render import render
    from vectorplot.save import save
    from vectorplot.scene.scene import Item, Light, Material, Page, Pattern, Scene
    from vectorplot.scene.surface_lines import Section, SurfaceLines
    from vectorplot.shading.raster.image import Image
    from vectorplot.words import LineKind

__version__ = "0.1.0"

__all__ = [
    "Camera",
    "Drawing",
    "Image",
    "InputError",
    "InputWarning",
    "Item",
    "Layer",
    "Light",
    "LineKind",
    "Material",
    "Mesh",
    "Page",
    "Paths",
    "Pattern",
    "Pen",
    "Scene",
    "Section",
    "Strokes",
    "SurfaceLines",
    "draw",
    "paint",
    "read",
    "render",
    "save",
]

_HOME = {
    "Camera": "geometry.cameras.camera",
    "Drawing": "drawing.drawing",
    "Image": "shading.raster.image",
    "InputError": "errors",
    "InputWarning": "errors",
    "Item": "scene.scene",
    "Layer": "drawing.drawing",
    "Light": "scene.scene",
    "LineKind": "words",
    "Material": "scene.scene",
    "Mesh": "geometry.mesh",
    "Page": "scene.scene",
    "Paths": "drawing.drawing",
    "Pattern": "scene.scene",
    "Pen": "drawing.drawing",
    "Scene": "scene.scene",
    "Section": "scene.surface_lines",
    "Strokes": "geometry.strokes",
    "SurfaceLines": "scene.surface_lines",
    "draw": "draw",
    "paint": "paint",
    "read": "io.read",
    "render": "render",
    "save": "save",
}


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    setattr(sys.modules[__name__], name, value)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


class _Package(ModuleType):
    """The package, in which a verb's name always means the verb.

    The import system stores the module ``vectorplot.draw`` as the attribute ``draw`` of the package; without this class
    ``vp.draw(scene)`` would fail as soon as anything had imported that module.
    """

    def __setattr__(self, name: str, value: object) -> None:
        if _HOME.get(name) == name and isinstance(value, ModuleType):
            value = getattr(value, name)
        super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
