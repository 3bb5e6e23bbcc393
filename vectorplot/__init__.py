"""3-D scenes as exact line drawings.

``import vectorplot as vp`` loads nothing but this file: every name of ``__init__.pyi`` beside it is imported when it is
first used, and so it is in the rooms (``from vectorplot.surfaces import Torus``). A verb's name always means the verb,
never the module it lies in.
"""

import lazy_loader

__version__ = "0.1.0"

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
