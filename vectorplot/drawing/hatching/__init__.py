"""Filled regions as strokes of a pen: hatching by the darkness of what is filled."""
