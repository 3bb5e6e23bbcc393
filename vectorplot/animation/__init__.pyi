from .animation import Animation
from .animation_file import read_animation
from .movies import packed

__all__ = [
    "Animation",
    "packed",
    "read_animation",
]
