"""Many runs."""

from __future__ import annotations

import json
import os
import re
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _given, _native, _program
from ._progress import Bar

if TYPE_CHECKING:
    import pandas


def sweep(
    study: Mapping[str, Any] | str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    progress: bool | None = None,
    **options: Any,
) -> pandas.DataFrame:
    """Runs a study: a scenario over settings and seeds, on all cores. One row per cell.

    `study` is a dict as in a study's file, the path of such a file, or the name of a study that comes with the program.
    In a dict, a scenario may be a dict, too. `out` is the folder that keeps the results (default: none); finished cells
    there are not run again. `options` are those of `sandbox sweep`: `threads=2`.

    The columns are `cell`, `seed`, `status`, the varied settings, `evacuated`, `time_secs`, and the measurements of the
    scenario, with the units in their names.
    """
    import pandas

    names: dict[str, str] = {}
    with tempfile.TemporaryDirectory() as folder:
        if isinstance(study, Mapping):
            text = _given.to_json(_with_files(dict(study), Path(folder), names))
            path = Path(folder, "study.json")
            path.write_text(text, encoding="utf-8")
        else:
            path = Path(_given.path_of(study))
        results = Path(folder, "results") if out is None else _given.path_of(out)
        options = options | {"out": results, "json": True}
        try:
            text = watched("sweep", str(path), options=options, progress=progress)
        except _native.Error as problem:
            # Files of a dict are gone when the message is read.
            raise _native.Error(str(problem).replace(f"{folder}{os.sep}", "")) from None
    rows = []
    for cell in json.loads(text)["cells"]:
        result = cell.get("result") or {}
        own = {"evacuated": result.get("evacuated"), "time_secs": result.get("time_secs")}
        row = {name: cell.get(name) for name in ("cell", "seed", "status")}
        settings = dict(cell["settings"])
        if "scenario" in settings:
            settings["scenario"] = names.get(settings["scenario"], settings["scenario"])
        rows.append(row | settings | own | result.get("metrics", {}))
    return pandas.DataFrame(rows)


def validate(
    *scenes: str,
    out: str | os.PathLike[str] | None = None,
    progress: bool | None = None,
    **options: Any,
) -> pandas.DataFrame:
    """Puts scenes of experiments beside what was measured there: one row per quantity, profile and seed.

    Without `scenes`, all are run. `options` are those of `sandbox validate`: `profile=["sph"]`, `seeds=3`, `data=DIR`.
    The columns are `case`, `profile`, `seed`, `quantity`, `value`, `least`, `most` (what was measured) and `passed`.
    """
    import pandas

    with tempfile.TemporaryDirectory() as folder:
        results = Path(folder) if out is None else Path(_given.path_of(out))
        table = results / "validation.csv"
        before = _written(table)
        names = map(_given.path_of, scenes)
        try:
            options = options | {"out": results}
            watched("validate", *names, options=options, progress=progress)
        except _native.Error:
            # A scene that misses its expectation is a result, too.
            if _written(table) == before:
                raise
        return pandas.read_csv(table, dtype={"case": "str"})


def _written(file: Path) -> int | None:
    """When the file was written, if it exists."""
    return file.stat().st_mtime_ns if file.exists() else None


def watched(command: str, *arguments: str, options: dict[str, Any], progress: bool | None) -> str:
    """The output of a command that says how far it is."""
    with Bar(100, "%", progress) as bar:

        def said(line: str) -> None:
            if found := re.match(r" *(\d+) %, ", line):
                bar.reach(int(found[1]))

        return _program.call(command, *arguments, options=options, said=said)


def _with_files(value: Any, folder: Path, names: dict[str, str]) -> Any:
    """The study with scenarios as files: those that are dicts are written to `folder`. `names` gets their names."""
    if isinstance(value, list):
        return [_with_files(one, folder, names) for one in value]
    if not isinstance(value, Mapping):
        return value
    found = {}
    for key, one in value.items():
        if key in ("list", "grid"):
            one = _with_files(one, folder, names)
        if key == "scenario":
            many = isinstance(one, list)
            files = [_file(scenario, folder, names) for scenario in (one if many else [one])]
            one = files if many else files[0]
        found[key] = one
    return found


def _file(scenario: Any, folder: Path, names: dict[str, str]) -> Any:
    """The path of a scenario."""
    if isinstance(scenario, Mapping):
        name = str(scenario.get("name", "scenario"))
        stem = re.sub(r"\W+", "-", name)[:50]
        path = folder / f"{stem}-{len(list(folder.iterdir()))}.json"
        path.write_text(_given.to_json(_absolute(scenario)), encoding="utf-8")
        names[str(path)] = name
        return str(path)
    if isinstance(scenario, (str, os.PathLike)) and scenario not in _native.scenarios():
        return os.path.abspath(_given.path_of(scenario))
    return scenario


def _absolute(scenario: Mapping[str, Any]) -> dict[str, Any]:
    """The scenario with absolute paths of the files that it names."""
    found = dict(scenario)
    for key in ("walkable_area", "obstacles"):
        if isinstance(found.get(key), str):
            found[key] = os.path.abspath(found[key])
    data = found.get("from")
    if isinstance(data, Mapping) and isinstance(data.get("trajectory"), str):
        found["from"] = dict(data) | {"trajectory": os.path.abspath(data["trajectory"])}
    return found
