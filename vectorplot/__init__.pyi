from .accuracy.verb import accuracy
from .animate import animate
from .animation.animation import Animation
from .animation.animation_file import read_animation
from .draw import draw
from .drawing.drawing import Drawing, Layer, Paths, Pen
from .drawing.pens.styles import Style
from .drawing.sheets.contact_sheets import contact_sheet
from .drawing.sheets.sheet import Sheet
from .effects.cutting.cut_scenes import cut
from .errors import InputError, InputWarning
from .film import Film
from .geometry.cameras.camera import Camera
from .geometry.cameras.panoramic_view import Panorama
from .geometry.mesh import Mesh
from .geometry.strokes import Strokes
from .paint import paint
from .panorama import panorama
from .read import read
from .render import render
from .save import save, save_for_latex
from .save_frames import save_frames
from .scene.cuts.exploded import exploded
from .scene.hatching import Hatching, Stippling
from .scene.item import Item, Pattern
from .scene.light import Light
from .scene.material import Material
from .scene.naming.annotations import arrow, axes
from .scene.naming.dimensions import angle, centre_line, centre_mark, diameter, dimension, leader, radius
from .scene.naming.labels import Along, AtVertex, Label, OnCurve, OnPage
from .scene.pages.page import Page
from .scene.plots import graph, surface, tube
from .scene.scene import Scene
from .scene.surface_lines import Section, SurfaceLines
from .shading.raster.image import Image
from .technical.technical_sheet import technical_sheet
from .technical.turntables import turntable
from .viewer.notebook import show
from .words import LineKind

__version__: str

__all__ = [
    "Along",
    "Animation",
    "AtVertex",
    "Camera",
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
    "Sheet",
    "Stippling",
    "Strokes",
    "Style",
    "SurfaceLines",
    "accuracy",
    "angle",
    "animate",
    "arrow",
    "axes",
    "centre_line",
    "centre_mark",
    "contact_sheet",
    "cut",
    "diameter",
    "dimension",
    "draw",
    "exploded",
    "graph",
    "leader",
    "paint",
    "panorama",
    "radius",
    "read",
    "read_animation",
    "render",
    "save",
    "save_for_latex",
    "save_frames",
    "show",
    "surface",
    "technical_sheet",
    "tube",
    "turntable",
]
