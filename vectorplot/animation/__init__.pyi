from .animation import MODES, Animation, Mode
from .animation_file import parse_animation, read_animation
from .movies import (
    Movie,
    MovieFrame,
    MoviePalette,
    decoded,
    encoded,
    frame_drawings,
    movie_of,
    packed,
    read_movie,
    unpacked,
)

__all__ = [
    "MODES",
    "Animation",
    "Mode",
    "Movie",
    "MovieFrame",
    "MoviePalette",
    "decoded",
    "encoded",
    "frame_drawings",
    "movie_of",
    "packed",
    "parse_animation",
    "read_animation",
    "read_movie",
    "unpacked",
]
