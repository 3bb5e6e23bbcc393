"""Files: the scene language and mesh formats, in and out."""
