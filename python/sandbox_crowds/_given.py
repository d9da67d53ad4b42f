"""Scenarios, studies and settings as the native part takes them."""

from __future__ import annotations

import json
import operator
import os
import warnings
from collections.abc import Mapping
from typing import Any

from . import _native
from ._model import Model, warn_of_step

Scenario = Mapping[str, Any] | str | os.PathLike[str]
"""A scenario: a dict as in a scenario file, the path of such a file, or a name of `scenarios()`."""


def to_json(value: Any) -> str:
    """JSON, also of NumPy's arrays and numbers; NaN and infinity are errors."""

    def plain(other: Any) -> Any:
        if isinstance(other, Mapping):
            return dict(other)
        if hasattr(other, "tolist"):
            return other.tolist()
        raise TypeError(f"{type(other).__name__} is not JSON: {str(other)[:100]}")

    try:
        return json.dumps(value, allow_nan=False, default=plain)
    except RecursionError:
        raise _native.Error("the value is nested too deeply") from None
    except ValueError as problem:
        raise _native.Error(f"{problem}; give finite numbers, and no value inside of itself") from None


def path_of(path: Any) -> str:
    """A path as text."""
    if not isinstance(path, (str, os.PathLike)):
        raise TypeError(f"expected a path, not {type(path).__name__}")
    text = os.fspath(path)
    if not isinstance(text, str):
        raise TypeError("expected a path in text, not in bytes")
    text.encode()  # no lone surrogates
    return text


def agent_id(agent: Any) -> int:
    """The id of an agent."""
    number = operator.index(agent)
    if not 0 <= number < 1 << 32:
        raise _native.Error(f"agent {number}: ids are whole numbers from 0")
    return number


def native(
    scenario: Scenario,
    geometry: str | os.PathLike[str] | None,
    settings: dict[str, Any],
    collect: tuple[float, list[str] | None] | None = None,
    model: Model | None = None,
) -> _native.Native:
    """A run before its second frame."""
    if isinstance(scenario, Mapping):
        name, text = "scenario", to_json(dict(scenario))
    elif isinstance(scenario, (str, os.PathLike)):
        name, text = path_of(scenario), None
    else:
        raise TypeError(f"a scenario is a dict or a path, not {type(scenario).__name__}")
    if model is not None and not isinstance(model, Model):
        raise TypeError("model: give sc.Model(function, …)")
    for key, value in settings.items():
        if isinstance(value, Model):
            raise TypeError(f"{key}: a model is given as `model=`")
    begun = _native.Native(
        {
            "name": name,
            "text": text,
            "settings": [_setting(key, value) for key, value in settings.items()],
            "geometry": None if geometry is None else path_of(geometry),
        },
        collect,
        None if model is None else model._given(),
    )
    warn_of_step(begun, model)
    for note in begun.notes:
        warnings.warn(note, stacklevel=3)
    return begun


KEYS = {"until": "duration_secs", "time_step": "time_step_secs"}
"""Short names of settings, as the program has them."""


def _setting(key: str, value: Any) -> tuple[str, str, str]:
    try:
        text = to_json(value)
    except _native.Error as problem:
        raise _native.Error(f"{key}: {problem}") from None
    shown = text if len(text) <= 60 else text[:60] + "…"
    return KEYS.get(key, key), text, f"{key}={shown}"
