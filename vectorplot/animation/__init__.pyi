from .animation import Animation
from .animation_file import parse_animation, read_animation
from .modes import MODES, Mode
from .movies.encoding import encoded
from .movies.movie import Movie, MovieFrame, MoviePalette
from .movies.packing import packed, unpacked
from .movies.reader import decoded, read_movie
from .movies.recorder import movie_of
from .movies.shown import frame_drawings

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
