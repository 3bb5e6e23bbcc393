"""What draws lines: pens by kind and by item, and styles."""
