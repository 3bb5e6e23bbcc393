from .answers import command_line, pressed
from .pictures import picture
from .state import first_state

__all__ = [
    "command_line",
    "first_state",
    "picture",
    "pressed",
]
