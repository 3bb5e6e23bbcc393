"""Lines on terrains: water, watersheds, roads, and where labels of level lines fit."""
