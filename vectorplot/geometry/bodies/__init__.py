"""Bodies as meshes: boxes, prisms, polyhedra from lists of faces, bodies of revolution."""
