"""What the sources teach and no verb needs: to learn from, and to build on."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
