"""A folder with all that was measured."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from vectorplot.accuracy.curves_of_error import Accuracy
from vectorplot.accuracy.error_plots import plot
from vectorplot.accuracy.error_tables import as_csv, as_json
from vectorplot.save import write, write_whole


def write_folder(measured: Sequence[Accuracy], folder: str, format: str) -> None:
    """Write table.csv, table.json and a plot for each approximation, by its name, into a folder, which is made where
    there is none. Each file is written whole or not at all."""
    files = {"table.csv": as_csv(measured).encode(), "table.json": as_json(measured).encode()}
    files |= {f"{one.name}.{format}": write(plot(one), format) for one in measured}
    place = Path(folder)
    place.mkdir(exist_ok=True)
    for name, content in files.items():
        write_whole(str(place / name), content)
