from .accuracy.verb import accuracy
from .draw import draw
from .drawing.drawing import Drawing, Layer, Paths, Pen
from .drawing.pens.styles import Style
from .errors import InputError, InputWarning
from .geometry.cameras.camera import Camera
from .geometry.cameras.panorama import Panorama
from .geometry.mesh import Mesh
from .geometry.strokes import Strokes
from .paint import paint
from .panorama import panorama
from .read import read
from .render import render
from .save import save, save_for_latex
from .scene.hatching import Hatching, Stippling
from .scene.naming.annotations import angle, arrow, axes, dimension
from .scene.naming.labels import Along, AtVertex, Label, OnCurve, OnPage
from .scene.plots import graph, surface, tube
from .scene.scene import Item, Light, Material, Page, Pattern, Scene
from .scene.surface_lines import Section, SurfaceLines
from .shading.raster.image import Image
from .words import LineKind

__version__: str

__all__ = [
    "Along",
    "AtVertex",
    "Camera",
    "Drawing",
    "Hatching",
    "Image",
    "InputError",
    "InputWarning",
    "Item",
    "Label",
    "Layer",
    "Light",
    "LineKind",
    "Material",
    "Mesh",
    "OnCurve",
    "OnPage",
    "Page",
    "Panorama",
    "Paths",
    "Pattern",
    "Pen",
    "Scene",
    "Section",
    "Stippling",
    "Strokes",
    "Style",
    "SurfaceLines",
    "accuracy",
    "angle",
    "arrow",
    "axes",
    "dimension",
    "draw",
    "graph",
    "paint",
    "panorama",
    "read",
    "render",
    "save",
    "save_for_latex",
    "surface",
    "tube",
]
