"""``python -m vectorplot``: the command."""

from vectorplot.cli.main import main

main()
