"""Where surfaces meet each other, meshes and themselves."""
