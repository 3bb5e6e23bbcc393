from .answers import command_line, pressed
from .notebook import show
from .pictures import picture
from .state import ViewerState, first_state

__all__ = [
    "ViewerState",
    "command_line",
    "first_state",
    "picture",
    "pressed",
    "show",
]
