from .animation import Animation
from .animation_file import parse_animation, read_animation
from .modes import MODES, Mode

__all__ = [
    "MODES",
    "Animation",
    "Mode",
    "parse_animation",
    "read_animation",
]
