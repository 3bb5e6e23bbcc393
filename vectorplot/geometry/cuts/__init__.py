"""Bodies that are cut: half spaces, divided meshes, the faces of sections."""
