"""Parts of surfaces: over smaller ranges of their parameters, and what planes leave of them."""
