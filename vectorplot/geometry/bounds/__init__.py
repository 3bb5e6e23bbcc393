"""Boxes and slabs about things: which of many overlap, or come near each other."""
