"""Lines on polygon meshes."""
