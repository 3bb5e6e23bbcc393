"""Animations: scenes that move from frame to frame, the files that describe them, and movies as files of polygons."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
