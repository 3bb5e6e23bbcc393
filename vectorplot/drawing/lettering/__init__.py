"""Letters of single strokes, as a pen writes them."""
