from .anything import scene_of
from .description import describe
from .expressions import Expression, parse_expression
from .molecules import Molecule, molecule_scene, read_molecule
from .scene_language import parse_scene, read_scene
from .scene_writer import write_scene
from .terrain_files import read_terrain

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
