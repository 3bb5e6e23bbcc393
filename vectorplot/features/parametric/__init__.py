"""Lines on parametrised surfaces."""
