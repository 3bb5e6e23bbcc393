"""Pictures for LaTeX, in PGF/TikZ."""
