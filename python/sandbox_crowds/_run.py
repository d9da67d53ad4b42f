"""Whole runs and their results."""

from __future__ import annotations

import json
import os
import socket
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _given, _native, _program, _tables
from ._native import Error
from ._picture import Picture
from ._model import Model
from ._progress import Bar
from ._simulation import SLICE, Simulation

if TYPE_CHECKING:
    import pandas
    import pedpy
    import shapely


def columns() -> dict[str, str]:
    """The columns of `Run.trajectory`, `Run.agents` and `Simulation.agents`, with their meanings and units.

    Those of legs are there only if people have legs.
    """
    return dict(_native.columns())


def run(
    scenario: _given.Scenario,
    *,
    fps: float = 10.0,
    columns: Iterable[str] | None = None,
    geometry: str | os.PathLike[str] | None = None,
    progress: bool | None = None,
    model: Model | None = None,
    **settings: Any,
) -> Run:
    """Runs a scenario to its end.

    `fps` is the number of frames per second of the trajectories, which must divide the simulation's; `columns` those
    that they keep (default: all of `columns()`; 8 bytes per value). `geometry` is the path of a floor plan that replaces
    the scenario's. `progress` shows a bar by tqdm (default: in notebooks and terminals). `model` is a model of one's own.
    `settings` are keys of the scenario; `until` is its duration in seconds.

    Raises `Error` with the place and the fix if something is invalid, or the simulation fails.
    """
    if isinstance(columns, str):
        raise TypeError("columns: give a list of names")
    wanted = None if columns is None else list(columns)
    native = _given.native(scenario, geometry, settings, (fps, wanted), model)
    with Bar(native.duration, "s", progress) as bar:
        while native.end is None:
            native.advance(1 << 62, SLICE, True)
            bar.reach(native.time)
    return Run(native, fps, model)


class Run:
    """A run that is over: its trajectories and measurements.

    Pictures and files are made by the program from the same scenario: it runs again, with the same results.
    """

    def __init__(self, native: _native.Native, fps: float, model: Model | None = None) -> None:
        self._model = model
        self._report = native.report()
        self._document = native.document
        self._name = native.name
        self._area = native.area()
        self._table: Any = native.take_trajectory()
        self._trajectory: pandas.DataFrame | None = None
        self._shown: Any = None
        self.fps = fps
        """Frames per second of the trajectories."""

    @property
    def measurements(self) -> dict[str, Any]:
        """The results, as `sandbox run --json` prints them; the scenario's measurements are in `["metrics"]`."""
        return json.loads(self._report)

    @property
    def trajectory(self) -> pandas.DataFrame:
        """Every agent in every frame, by frame and id: `columns()` has the meanings and units."""
        if self._trajectory is None:
            self._trajectory = _tables.frame(self._table)
        return self._trajectory

    def agents(self, at: float) -> pandas.DataFrame:
        """The agents in the frame that is nearest to the time `at` in seconds, one row each: columns as in
        `trajectory`."""
        table = self.trajectory
        if "frame" not in table:
            raise Error("columns: `frame` is needed to find the agents of a time")
        try:
            at = float(at)
        except ValueError:
            raise Error(f"at={at!r}: not a time in seconds, 0 or later") from None
        if not 0 <= at <= 1e9:
            raise Error(f"at={at!r}: not a time in seconds, 0 or later")
        frame, end = round(at * self.fps), self.measurements["time_secs"]
        if frame > end * self.fps + 0.5:
            raise Error(f"at={at}: the run ended at {end:.2f} s")
        begin, behind = table["frame"].searchsorted([frame, frame + 1])
        return table.iloc[begin:behind].reset_index(drop=True)

    @property
    def geometry(self) -> shapely.Geometry:
        """The walkable area, m, as a polygon of shapely; several polygons if obstacles divide it."""
        import shapely

        return shapely.from_wkt(self._area)

    def to_pedpy(self) -> tuple[pedpy.TrajectoryData, pedpy.WalkableArea]:
        """The trajectories and the walkable area for PedPy."""
        import pedpy

        table = self.trajectory
        missing = {"frame", "id", "pos_x", "pos_y"}.difference(table)
        if missing:
            raise Error(f"columns: PedPy needs {', '.join(sorted(missing))}, too")
        names = {"pos_x": "x", "pos_y": "y"}
        data = table[["id", "frame", "pos_x", "pos_y"]].rename(columns=names)
        data = data.astype({"id": "int64", "frame": "int64"})
        return pedpy.TrajectoryData(data=data, frame_rate=self.fps), pedpy.WalkableArea(self.geometry)

    def draw(self, at: float = 0.0, out: Any = None, **options: Any) -> Picture | None:
        """The crowd at the time `at` in seconds as a picture, which a notebook shows.

        With `out`, a file .svg, .png or .pdf is written instead. `options` are those of `sandbox draw`: `color="speed"`,
        `trails=2`, `field="density"`, `paths=["east exit"]`, `range=(0, 8)`, `width=85`, `dpi=150`. With `from_` and `to`
        instead of `at`, `out` is an animation.
        """
        if "from_" in options:
            options["from"] = options.pop("from_")
        else:
            options["at"] = at
        if out is not None:
            self._program("draw", options | {"out": _given.path_of(out)})
            return None
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "picture.png")
            self._program("draw", {"dpi": 100} | options | {"out": path})
            return Picture(path.read_bytes())

    def save(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Writes a recording for the Rerun viewer (.rrd), a page for any browser (.html), or trajectories (.sqlite, .db,
        .txt, .csv).

        `options` are those of `sandbox run`: `record_every=5`, `debug_agents="17,42"`, `trajectory_fps=25`, `force=True`
        to replace a file.
        """
        text = _given.path_of(path)
        option = "save" if text.lower().endswith((".rrd", ".html")) else "trajectory"
        self._program("run", options | {option: text})

    def inspect(self, agent: int, at: float) -> dict[str, Any]:
        """Every force on an agent at the time `at` in seconds, as `sandbox inspect --json` prints them."""
        found = self._program("inspect", {"agent": agent, "at": at, "json": True})
        return json.loads(found)["agents"][0]

    def view(self, live: bool = False, **options: Any) -> Any:
        """The run in a Rerun viewer, in a notebook; needs `rerun-sdk[notebook]`. `options` are those of `save`.

        `live`: the viewer shows the run while the program repeats it. The browser must be on this machine.
        """
        import rerun
        from rerun.notebook import Viewer

        recording = rerun.RecordingStream(self._name)
        if live:
            with socket.socket() as free:
                free.bind(("127.0.0.1", 0))
                port = free.getsockname()[1]
            address = recording.serve_grpc(grpc_port=port)
            viewer = Viewer(url=address)
            viewer.display()
            self._program("run", options | {"connect": address})
            self._shown = recording  # the viewer has its data as long as this exists
            return None
        viewer = Viewer(recording=recording)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "run.rrd")
            self.save(path, **options)
            recording.log_file_from_path(path)
            recording.flush()
        return viewer

    def _program(self, command: str, options: dict[str, Any]) -> str:
        """Runs a command on the scenario of this run, with all its settings."""
        if self._model is not None:
            return self._of_recording(command, options)
        with tempfile.TemporaryDirectory() as folder:
            name = "".join(c if c.isalnum() else "-" for c in self._name)
            path = Path(folder, f"{name[:50] or 'scenario'}.json")
            path.write_text(self._document, encoding="utf-8")
            return _program.call(command, str(path), options=options)

    def _of_recording(self, command: str, options: dict[str, Any]) -> str:
        """Runs a command on a recording of this run: the program does not know the model."""
        given = {name: value for name, value in options.items() if name != "save"}
        if command == "inspect":
            again = self._again()
            again.step(round(options["at"] / again.time_step))
            return json.dumps({"agents": [again.inspect(options["agent"])]})
        path = options.get("save") or options.get("out")
        if command == "run" and "save" not in options:
            raise Error("the program does not know the model: write `Run.trajectory`, or save .rrd or .html")
        if path is not None and os.path.exists(path) and not options.get("force"):
            raise Error(f"{path} exists; give force=True to replace it")
        if path is not None and os.fspath(path).lower().endswith(".rrd"):
            self._record(path)
            return ""
        with tempfile.TemporaryDirectory() as folder:
            recording = Path(folder, "run.rrd")
            self._record(recording)
            return _program.call("draw", str(recording), options=given | ({"out": path} if path else {}))

    def _record(self, path: str | os.PathLike[str]) -> None:
        again = self._again()
        with again.record(path):
            while again.end is None:
                again.step()

    def _again(self) -> Simulation:
        return Simulation(json.loads(self._document), model=self._model)

    def __repr__(self) -> str:
        found = self.measurements
        agents, time = found["agents"], found["time_secs"]
        return f"<Run of {self._name!r}: {agents} agents, {time:.2f} s>"
