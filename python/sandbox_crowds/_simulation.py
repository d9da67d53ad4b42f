"""A simulation step by step."""

from __future__ import annotations

import collections
import contextlib
import json
import math
import operator
import os
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _given, _tables
from ._control import Control
from ._model import Model, frame_of, measured
from ._native import Error, Native

if TYPE_CHECKING:
    import numpy
    import pandas
    import shapely

SLICE = 0.05
"""The longest time in the native part before Python sees Ctrl-C, seconds."""


EVENT = [("id", "i8"), ("time", "f8"), ("x", "f8"), ("y", "f8"), ("place", "i4"), ("direction", "i4")]
"""The fields of `Events`: the id; s; m; the number of the place, or -1; 1 from the left of a line to its right, -1 the
other way, 0 for what is no crossing."""


class Events(NamedTuple):
    """What happened since the last call: structured arrays with the fields `EVENT`, in the order of time."""

    entered: numpy.ndarray
    """Those who entered, with their positions in their first frame."""
    left: numpy.ndarray
    """Those who left at an exit (its number in `place`) or at their goal (-1), with their last positions."""
    removed: numpy.ndarray
    """Those who were taken out."""
    crossed: numpy.ndarray
    """Those who crossed the line of an exit, a door or a waypoint, and are still present."""
    stuck: numpy.ndarray
    """The ids of those who are stuck and were not: int64."""


class Simulation(Control):
    """A crowd, frame by frame. Between calls, everything matches: positions, densities and forces are of the same frame.

    The same calls give the same bits, on any number of threads. Reading never changes the results. Arrays are copies,
    with one row per agent that is present, in the order of `ids`.

    Other threads of Python run during `step`; a simulation may be used by one thread at a time.
    """

    def __init__(
        self,
        scenario: _given.Scenario,
        *,
        geometry: str | os.PathLike[str] | None = None,
        model: Model | None = None,
        **settings: Any,
    ) -> None:
        """A simulation of `scenario` in its first frame.

        `geometry` is the path of a floor plan that replaces the scenario's. `model` is a model of one's own. `settings`
        are keys of the scenario; `until` is its duration in seconds.

        Raises `Error` with the place and the fix if something is invalid.
        """
        self._begin(_given.native(scenario, geometry, settings, None, model), model)

    def _begin(self, native: Native, model: Model | None) -> None:
        self._model = model
        self._native = native
        self._kept: collections.deque[Native] | None = None
        self._every = 0

    def step(self, frames: int = 1) -> None:
        """Simulates `frames` frames, also beyond the end of the scenario.

        After Ctrl-C, fewer frames are simulated, and the simulation can go on.
        """
        left = operator.index(frames)
        if left < 0:
            raise Error(f"frames={left}: give 0 or more")
        while left > 0:
            left -= self._native.advance(min(left, self._until_kept()), SLICE, False)
            self._keep_if_due()

    @property
    def frame(self) -> int:
        """The number of the current frame, from 0."""
        return self._native.frame

    @property
    def time(self) -> float:
        """The time of the current frame, s."""
        return self._native.time

    @property
    def time_step(self) -> float:
        """The time between two frames, s."""
        return self._native.time_step

    @property
    def end(self) -> str | None:
        """Why a run of the scenario would end at the current frame, in words; `None` if it would go on."""
        return self._native.end

    def __len__(self) -> int:
        """The number of agents that are present."""
        return self._native.agents

    @property
    def ids(self) -> numpy.ndarray:
        """The ids of the agents that are present, ascending: uint32 of shape (agents,)."""
        return _tables.array(self._native.ids(), "uint32")

    @property
    def positions(self) -> numpy.ndarray:
        """Positions, m: float64 of shape (agents, 2). A copy."""
        return _tables.array(self._native.positions(), "float64", -1, 2)

    @property
    def velocities(self) -> numpy.ndarray:
        """Velocities, m/s: float64 of shape (agents, 2). A copy."""
        return _tables.array(self._native.velocities(), "float64", -1, 2)

    @property
    def densities(self) -> numpy.ndarray:
        """Densities by SPH, P/m²: float64 of shape (agents,). A copy."""
        return _tables.array(self._native.densities(), "float64")

    def agents(self) -> pandas.DataFrame:
        """Every quantity of every agent, one row per agent: `columns()` has their meanings and units."""
        return _tables.frame(self._native.table())

    def _keep_now(self) -> None:
        if self._kept is not None:
            if self._kept[-1].frame == self.frame:
                self._kept.pop()
            self._kept.append(self._native.fork())

    def fork(self) -> Simulation:
        """An independent copy in the same frame, with all measurements so far.

        Both go on to the same bits if the same is done to them. Walls, path maps and the scenario are shared; the rest is
        some 250 bytes per agent and takes about as long as a frame. Snapshots of `keep` are not copied.
        """
        fork = Simulation.__new__(Simulation)
        fork._begin(self._native.fork(), self._model)
        return fork

    def save(self) -> bytes:
        """The state in the current frame as bytes: those of a checkpoint, which `sandbox resume` reads, too."""
        return self._native.save()

    @staticmethod
    def restore(saved: bytes, model: Model | None = None) -> Simulation:
        """The simulation that was saved, in the same frame; it goes on to the same bits. `model`: that of the simulation,
        if it had one; saved bytes do not have it.

        Raises `Error` if the bytes are damaged, or of another version of the program.
        """
        restored = Simulation.__new__(Simulation)
        given = None if model is None else model._given()
        try:
            native = Native.restored(bytes(saved), given)
        except Error as problem:
            hint = "; if it had a model, give it to `restore`" if model is None and "belong" in str(problem) else ""
            raise Error(f"{problem}{hint}") from None
        restored._begin(native, model)
        return restored

    def keep(self, every: float = 1.0, most: int = 60) -> None:
        """Keeps a snapshot now and every `every` seconds, for `rewind`: the latest `most` of them, each a fork. What
        is done from outside is kept, too."""
        if not (0 < every < math.inf and operator.index(most) > 0):
            raise Error(f"every={every}, most={most}: give finite numbers above 0")
        self._every = max(1, round(every / self.time_step))
        self._kept = collections.deque([self._native.fork()], maxlen=most)

    def rewind(self, secs: float) -> None:
        """Goes back by `secs` seconds, to the frame at that time: exactly as it was. What was done since is undone.

        Raises `Error` without `keep`, or if the time is before the first snapshot that is kept.
        """
        if self._kept is None:
            raise Error("rewind: call keep() first, from which on one can go back")
        if not 0 <= secs < math.inf:
            raise Error(f"secs={secs}: give a finite number from 0 on")
        native = self._native
        frame = native.frame - round(secs / native.time_step)
        first = self._kept[0]
        if frame < first.frame:
            raise Error(
                f"secs={secs}: that is before {first.time:.2f} s, the first snapshot that is kept; keep more of them"
            )
        while self._kept[-1].frame > frame:
            self._kept.pop()
        self._native = self._kept[-1].fork()
        self.step(frame - self.frame)

    def _until_kept(self) -> int:
        """The number of frames until the next snapshot."""
        if self._kept is None:
            return 1 << 62
        return max(1, self._kept[-1].frame + self._every - self.frame)

    def _keep_if_due(self) -> None:
        if self._kept is not None and self.frame >= self._kept[-1].frame + self._every:
            self._kept.append(self._native.fork())

    def inspect(self, agent: int) -> dict[str, Any]:
        """Every force on an agent in the current frame, as `sandbox inspect --json` prints them: accelerations in m/s²,
        by profile and term, neighbors, walls, its way and its journey."""
        return json.loads(self._native.inspect(_given.agent_id(agent)))

    def measure_model(self) -> dict[str, float]:
        """The stiffness, 1/s², and the friction, 1/s, of the model in the current frame: the largest changes of its
        accelerations with positions and velocities. Contacts that come later may be stiffer: measure where people press.
        """
        if self._model is None:
            raise Error("measure_model: the simulation has no model of one's own")
        frame = frame_of(*self._native.model_frame(self._model.reach), self._model.reach)
        stiffness, friction = measured(self._model, frame)
        return {"stiffness": stiffness, "friction": friction}

    def events(self) -> Events:
        """What happened since the last call: arrays that stay valid. The first call begins to watch, and returns none."""
        import numpy

        rows, stuck = self._native.take_events()
        arrays = [numpy.frombuffer(part, dtype=numpy.dtype(EVENT)) for part in rows]
        return Events(*arrays, numpy.array(stuck, "int64"))

    @property
    def places(self) -> list[str]:
        """The names of exits, doors, waypoints, waiting areas and queues: number k is place k of `events`."""
        return self._native.places

    @contextlib.contextmanager
    def record(
        self,
        path: str | os.PathLike[str],
        *,
        every: int = 5,
        debug_agents: Iterable[int] | None = None,
    ) -> Iterator[None]:
        """Records what happens inside of `with simulation.record("out.rrd"):` for the Rerun viewer, one of `every` frames:
        people, walls, density, and the forces on `debug_agents` by id (default: a dozen), with those of a model of one's
        own. An existing file is replaced. A `rewind` ends the recording.
        """
        text = _given.path_of(path)
        if operator.index(every) < 1:
            raise Error(f"every={every}: give 1 or more")
        ids = None if debug_agents is None else [_given.agent_id(one) for one in debug_agents]
        native = self._native
        native.record(text, every, ids)
        try:
            yield
        finally:
            native.finish_recording()

    @property
    def measurements(self) -> dict[str, Any]:
        """The results so far, as `sandbox run --json` prints them; the scenario's measurements are in `["metrics"]`."""
        return json.loads(self._native.report())

    @property
    def state_sha256(self) -> str:
        """A SHA-256 of the state; equal states have equal ones."""
        return self._native.digest()

    @property
    def geometry(self) -> shapely.Geometry:
        """The walkable area, m, as a polygon of shapely; several polygons if obstacles divide it."""
        import shapely

        return shapely.from_wkt(self._native.area())

    def __repr__(self) -> str:
        name, time = self._native.name, self._native.time
        return f"<Simulation of {name!r}: {len(self)} agents at {time:.2f} s>"
