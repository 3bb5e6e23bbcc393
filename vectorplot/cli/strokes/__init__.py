"""Options for how strokes and hatchings look."""
