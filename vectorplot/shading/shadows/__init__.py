"""Shadow buffers and shadow maps."""
