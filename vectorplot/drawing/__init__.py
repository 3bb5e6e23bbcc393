"""The display list and what is done to it: joining, duplicates, layers, pen order, the page."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
