"""Arrays and DataFrames of the native part's values."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy
    import pandas

    from ._native import _Columns


def array(values: bytearray, dtype: str, *shape: int) -> numpy.ndarray:
    """An array of these bytes; it is a copy of the simulation's values, and may be changed."""
    import numpy

    return numpy.frombuffer(values, dtype).reshape(*shape or (-1,))


def frame(columns: _Columns) -> pandas.DataFrame:
    """A DataFrame of these columns; names are categories."""
    import pandas

    def values(dtype: str, values: bytearray, names: list[str] | None) -> object:
        numbers = array(values, dtype)
        if names is None:
            return numbers
        return pandas.Categorical.from_codes(numbers, names)

    # Column by column, so that both copies exist of one column only.
    made = {}
    for name in list(columns):
        made[name] = values(*columns.pop(name))
    return pandas.DataFrame(made, copy=False)
