"""The command ``vectorplot``."""
