from .accuracy.verb import accuracy
from .animation.animation import Animation
from .animation.animation_file import read_animation
from .drawing.drawing import Drawing, Layer, Paths, Pen
from .drawing.pens import Style
from .drawing.sheets import Sheet, contact_sheet, panels
from .effects.cuts import cut
from .errors import InputError, InputWarning
from .features.zero_curves import zero_manifold_of_f_uv
from .geometry.camera import Camera, Panorama
from .geometry.mesh import Mesh
from .geometry.polylines import Strokes
from .pictures.anamorphosis import AnamorphicMirror, anamorphosis, anamorphosis_view
from .pictures.development import development
from .pictures.draw import draw
from .pictures.film import Film, animate
from .pictures.paint import paint
from .pictures.panorama import panorama
from .pictures.render import render
from .pictures.sheet_annotations import part_scenes
from .pictures.technical_sheet import technical_sheet, turntable
from .read import read
from .save import save, save_for_latex
from .save_frames import save_frames
from .scene.annotations import (
    angle,
    arrow,
    axes,
    baseline_dimension,
    centre_line,
    centre_mark,
    chain_dimension,
    chamfer,
    diameter,
    dimension,
    leader,
    ordinate_dimension,
    radius,
    thread,
    threaded_hole,
)
from .scene.colour_scales import Colouring, ScaleBar
from .scene.exploded import exploded
from .scene.hatching import Hatching, Stippling
from .scene.item import Item, Pattern
from .scene.labels import Along, AtVertex, Label, Measures, OnCurve, OnPage
from .scene.light import Light
from .scene.material import Material
from .scene.page import Page
from .scene.plots import graph, surface, tube
from .scene.scene import Scene
from .scene.subdivided import subdivided
from .scene.surface_lines import Section, SurfaceLines
from .scene.united import united
from .shading.image import Image
from .viewer.notebook import show
from .words import LineKind

__version__: str

__all__ = [
    "Along",
    "AnamorphicMirror",
    "Animation",
    "AtVertex",
    "Camera",
    "Colouring",
    "Drawing",
    "Film",
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
    "Measures",
    "Mesh",
    "OnCurve",
    "OnPage",
    "Page",
    "Panorama",
    "Paths",
    "Pattern",
    "Pen",
    "ScaleBar",
    "Scene",
    "Section",
    "Sheet",
    "Stippling",
    "Strokes",
    "Style",
    "SurfaceLines",
    "accuracy",
    "anamorphosis",
    "anamorphosis_view",
    "angle",
    "animate",
    "arrow",
    "axes",
    "baseline_dimension",
    "centre_line",
    "centre_mark",
    "chain_dimension",
    "chamfer",
    "contact_sheet",
    "cut",
    "development",
    "diameter",
    "dimension",
    "draw",
    "exploded",
    "graph",
    "leader",
    "ordinate_dimension",
    "paint",
    "panels",
    "panorama",
    "part_scenes",
    "radius",
    "read",
    "read_animation",
    "render",
    "save",
    "save_for_latex",
    "save_frames",
    "show",
    "subdivided",
    "surface",
    "technical_sheet",
    "thread",
    "threaded_hole",
    "tube",
    "turntable",
    "united",
    "zero_manifold_of_f_uv",
]
