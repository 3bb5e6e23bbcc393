"""How fine triangles have to be, so that a shaded picture shows none of them."""
