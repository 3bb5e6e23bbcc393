from .expressions.expression import Expression, parse_expression
from .info import describe
from .scenes.scene_language import parse_scene, read_scene
from .scenes.scene_writer import write_scene

__all__ = [
    "Expression",
    "describe",
    "parse_expression",
    "parse_scene",
    "read_scene",
    "write_scene",
]
