"""Meshes as they come, made sound: welded, wound alike, without what has no area."""
