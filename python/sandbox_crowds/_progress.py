"""Progress bars."""

from __future__ import annotations

import sys
from typing import Any


class Bar:
    """A progress bar by tqdm, in a notebook or a terminal, for what takes more than a second; nothing without tqdm."""

    def __init__(self, total: float, unit: str, progress: bool | None) -> None:
        self._bar: Any = None
        if progress is None:
            progress = "ipykernel" in sys.modules or sys.stderr is not None and sys.stderr.isatty()
        if not progress:
            return
        try:
            from tqdm.auto import tqdm
        except ImportError:
            return
        form = "{percentage:3.0f} %|{bar}| {n:.1f}/{total:.1f} {unit} [{elapsed}<{remaining}]"
        self._bar = tqdm(total=total, unit=unit, delay=1, leave=False, bar_format=form)

    def reach(self, value: float) -> None:
        """Shows this value."""
        if self._bar is not None:
            self._bar.update(value - self._bar.n)

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()
