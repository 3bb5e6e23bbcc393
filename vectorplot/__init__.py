"""3-D scenes as exact line drawings."""

__version__ = "0.1.0"
