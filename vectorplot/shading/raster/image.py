"""A picture of pixels: what render gives."""

from __future__ import annotations

import os
from dataclasses import dataclass

from vectorplot.errors import InputError
from vectorplot.shading.raster.png import DPI, Bytes, png_bytes


@dataclass(frozen=True, eq=False)
class Image:
    """A picture of pixels.

    Parameters
    ----------
    pixels : (rows, columns, 3) array of uint8
        Red, green and blue, row 0 on top.
    title : str
        What it shows.
    dpi : float
        The dots per inch that its file says, those of drawings saved as pixels unless told otherwise.

    Raises
    ------
    InputError
        For other shapes or types.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> vp.Image(np.zeros((40, 60, 3), dtype=np.uint8), "Night")
    <Image 'Night': 60 x 40 pixels>
    """

    pixels: Bytes
    title: str = ""
    dpi: float = DPI

    def __post_init__(self) -> None:
        if self.pixels.dtype != "uint8" or self.pixels.ndim != 3 or self.pixels.shape[2] != 3 or not self.pixels.size:
            raise InputError(f"an image needs bytes of shape (rows, columns, 3), not {self.pixels.shape}")

    def __repr__(self) -> str:
        return f"<Image {self.title!r}: {self.columns} x {self.rows} pixels>"

    @property
    def columns(self) -> int:
        """How many columns of pixels there are."""
        return int(self.pixels.shape[1])

    @property
    def rows(self) -> int:
        """How many rows of pixels there are."""
        return int(self.pixels.shape[0])

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the picture as PNG, as `vp.save` does.

        Parameters
        ----------
        path : str or path
            The file, whose name ends in .png.

        Raises
        ------
        InputError
            For another suffix.
        OSError
            Where the file cannot be written.

        Examples
        --------
        >>> import os, tempfile
        >>> import numpy as np
        >>> import vectorplot as vp
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     vp.Image(np.zeros((4, 6, 3), dtype=np.uint8)).save(os.path.join(folder, "night.png"))
        ...     os.listdir(folder)
        ['night.png']
        """
        from vectorplot.save import save

        save(self, path)

    def png(self) -> bytes:
        """The picture as a PNG file. The same picture gives the same bytes."""
        return png_bytes(self.pixels, dpi=self.dpi)

    def _repr_png_(self) -> bytes:
        return self.png()
