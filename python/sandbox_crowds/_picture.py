"""Pictures that notebooks show."""

from __future__ import annotations

import os
from pathlib import Path


class Picture:
    """A picture as PNG. Notebooks show it."""

    def __init__(self, png: bytes) -> None:
        self.png = png

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the picture to a file."""
        Path(path).write_bytes(self.png)

    def _repr_png_(self) -> bytes:
        return self.png
