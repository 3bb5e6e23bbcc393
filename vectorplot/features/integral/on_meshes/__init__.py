"""Integral curves, straightest and shortest lines on meshes: from face to face."""
