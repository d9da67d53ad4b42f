"""Results with the errors asked for."""

from __future__ import annotations

import json
import os
import tempfile
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _given, _native
from ._picture import Picture
from ._study import watched

if TYPE_CHECKING:
    import pandas


def estimate(
    scenario: _given.Scenario,
    errors: Mapping[str, float | str] | None = None,
    *,
    bound: Mapping[str, str] | None = None,
    runs: str | None = None,
    confidence: float = 95,
    most_runs: int | None = None,
    most_minutes: float | None = None,
    threads: int | None = None,
    out: str | os.PathLike[str] | None = None,
    geometry: str | os.PathLike[str] | None = None,
    progress: bool | None = None,
    **settings: Any,
) -> Estimate:
    """Computes results with the errors asked for: chooses time steps and numbers of runs.

    `errors` has the half width of the confidence interval of each result, in percent of the value or in its unit:
    `{"flow_per_s": "1%", "density_mean_15s": 0.05}`. `bound` has the share of runs that shall be at most a bound, for
    results whose bounds are wanted: `{"time_secs": "95%"}`; with `runs="imo"` they are made of 50 runs as in IMO's
    guidelines. `confidence` is in percent. `out` is the folder that keeps the runs (default: none); runs finished there
    are not made again. `settings` are keys of the scenario, as for `run`.

    If a limit ends the estimate before all errors are as small as asked for, a warning says so. Raises `Error` if
    something is invalid, or a result has no value.
    """
    native = _given.native(scenario, geometry, settings)
    wanted = [f"{name}={error}" for name, error in (errors or {}).items()]
    shares = [f"{name}={share}" for name, share in (bound or {}).items()]
    if not wanted and not shares:
        raise _native.Error("nothing is asked for: give errors, such as {'flow_per_s': '1%'}, or bound")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "scenario.json")
        path.write_text(native.document, encoding="utf-8")
        results = Path(folder, "results") if out is None else Path(_given.path_of(out))
        options = {
            "error": wanted,
            "bound": shares,
            "runs": runs,
            "confidence": confidence,
            "most_runs": most_runs,
            "most_minutes": most_minutes,
            "threads": threads,
            "out": results,
            "json": True,
            "force": True,
        }
        before = _written(results)
        try:
            watched("estimate", str(path), options=options, progress=progress)
        except _native.Error as problem:
            # A limit: the answer is written all the same.
            if _written(results) == before:
                raise _native.Error(str(problem).replace(f"{folder}{os.sep}", "")) from None
            warnings.warn(str(problem), stacklevel=2)
        written = max(_written(results).items(), key=lambda item: item[1])[0]
        answer = json.loads(written.read_text(encoding="utf-8"))["estimate"]
        stem = written.with_suffix("")
        pictures = [Path(f"{stem}{of}.png") for of in ("", "-bounds")]
        return Estimate(answer, [path.read_bytes() for path in pictures if path.exists()])


def _written(folder: Path) -> dict[Path, int]:
    """The answers in a folder, and when they were written."""
    return {path: path.stat().st_mtime_ns for path in folder.glob("*.json")}


class Estimate:
    """Results with their errors: chance and the time step, not the model's own error."""

    def __init__(self, answer: dict[str, Any], pngs: list[bytes]) -> None:
        self.answer = answer
        """Everything, as `sandbox estimate --json` prints it; the values of all runs are in it."""
        self._pngs = pngs

    @property
    def table(self) -> pandas.DataFrame:
        """One row per result, by name: its `value` in the limit of fine steps; half the width of its confidence interval,
        `error`, and the parts of it from `seeds` and `step`; `n`, the number of runs; whether the error asked for is
        `reached`."""
        import pandas

        rows = [
            {name: row[name] for name in ("value", "error", "seeds", "step")}
            | {"n": sum(at["runs"] for at in row["steps"]), "reached": row["is_reached"]}
            for row in self.answer["results"]
        ]
        names = [row["name"] for row in self.answer["results"]]
        return pandas.DataFrame(rows, index=pandas.Index(names, name="result"))

    @property
    def bounds(self) -> pandas.DataFrame:
        """One row per bound, by result: the `bound`, the `share` of runs that are at most it, the number of runs `n`, and the
        probability that the statement is true, `confidence`."""
        import pandas

        bounds = self.answer.get("bounds", [])
        rows = [
            {"bound": of["value"], "share": of["share"], "n": of["runs"], "confidence": of["confidence"]}
            for of in bounds
        ]
        names = pandas.Index([of["name"] for of in bounds], name="result")
        return pandas.DataFrame(rows, index=names, columns=["bound", "share", "n", "confidence"])

    def plot(self) -> Picture:
        """The way to each result: means at each time step, errors by the number of runs and by computing time. Without
        results: the shares of runs below each bound."""
        return Picture(self._pngs[0])

    def __repr__(self) -> str:
        return repr(self._main())

    def _repr_html_(self) -> str | None:
        return self._main().to_html()

    def _main(self) -> pandas.DataFrame:
        return self.table if self.answer["results"] else self.bounds
