from .answers import KEYS, command_line, pressed
from .notebook import show
from .pictures import picture
from .state import ViewerState, first_state

__all__ = [
    "KEYS",
    "ViewerState",
    "command_line",
    "first_state",
    "picture",
    "pressed",
    "show",
]
