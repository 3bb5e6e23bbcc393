"""What users import to verify drawings in their own tests: assertions, an oracle, and shapes that are hard."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
