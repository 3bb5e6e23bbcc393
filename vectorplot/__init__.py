"""3-D scenes as exact line drawings.

``import vectorplot as vp`` loads nothing but this file: every name of ``__init__.pyi`` beside it is imported when it is
first used, and so it is in the rooms (``from vectorplot.surfaces import Torus``). A verb's name always means the verb,
never the module it lies in.
"""

import lazy_loader

__version__ = "0.1.0"

_named, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> object:
    """What the package exports by this name. Errors: AttributeError, with the rooms that have such a name."""
    try:
        return _named(name)
    except AttributeError:
        rooms = [] if name.startswith("_") else _rooms_of(name)
        hint = f": from vectorplot.{rooms[0]} import {name}" if rooms else ""
        raise AttributeError(f"vectorplot has no {name!r}{hint}", name=name) from None


def _rooms_of(name: str) -> list[str]:
    """The rooms of the package that export a name."""
    from pathlib import Path

    stubs = sorted(Path(__file__).parent.glob("*/__init__.pyi"))
    return [stub.parent.name for stub in stubs if f'    "{name}",\n' in stub.read_text(encoding="utf-8")]
