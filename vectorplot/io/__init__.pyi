from .anything import scene_of
from .description import describe
from .expressions.expression import Expression, parse_expression
from .molecules.molecule import Molecule
from .molecules.molecule_scene import molecule_scene
from .molecules.read_molecule import read_molecule
from .scenes.scene_language import parse_scene, read_scene
from .scenes.scene_writer import write_scene
from .terrains.read_terrain import read_terrain

__all__ = [
    "Expression",
    "Molecule",
    "describe",
    "molecule_scene",
    "parse_expression",
    "parse_scene",
    "read_molecule",
    "read_scene",
    "read_terrain",
    "scene_of",
    "write_scene",
]
