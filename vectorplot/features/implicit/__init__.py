"""Lines on implicit surfaces, and triangles that stand for them."""
