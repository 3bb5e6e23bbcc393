"""``python -m vectorplot``: the command."""

from __future__ import annotations

from vectorplot.cli.main import main

main()
