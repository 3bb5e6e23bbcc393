from .anything import scene_of
from .molecules import Molecule, molecule_scene, read_molecule
from .scene_language import parse_scene
from .terrain_files import read_terrain

__all__ = [
    "Molecule",
    "molecule_scene",
    "parse_scene",
    "read_molecule",
    "read_terrain",
    "scene_of",
]
