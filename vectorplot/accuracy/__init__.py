"""What accuracy costs in time: every approximation of the package, its errors measured over its knob."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
