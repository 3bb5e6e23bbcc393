"""Hidden lines of straight edges behind faces and convex bodies."""
