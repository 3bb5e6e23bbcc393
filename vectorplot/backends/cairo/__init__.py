"""PostScript, EPS, PDF and PNG, through cairo."""
