"""Hidden lines by geometry."""
