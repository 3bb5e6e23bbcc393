"""The interactive program: what one looks at, the keys that change it, its picture, and the web page around it."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
