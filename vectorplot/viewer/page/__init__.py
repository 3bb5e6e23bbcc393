"""The page as a browser gets it: HTML, style, scripts, an icon."""
