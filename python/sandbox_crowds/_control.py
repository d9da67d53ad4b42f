"""Control of a simulation from outside."""

from __future__ import annotations

import json
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _given
from ._model import Model
from ._native import Error, Native

if TYPE_CHECKING:
    import numpy


class Added(NamedTuple):
    """What became of people who were to be added."""

    ids: numpy.ndarray
    """The ids of those who enter, in order: int64 of shape (entering,)."""
    without_room: numpy.ndarray
    """The places in the given positions, from 0, of those without room, who do not enter: int64."""


class Control:
    """What can be done to a simulation from outside. Everything acts at the beginning of the next frame. If something
    is not possible, `Error` says why, and nothing is done. All that was done is part of the run: `scenario()` has it,
    and saved states and forks go on with it."""

    _native: Native
    _model: Model | None

    def _keep_now(self) -> None:
        """Keeps a snapshot with what was done, for `rewind`."""
        raise NotImplementedError

    def _do(self, action: str, keys: Any) -> tuple[list[int], list[int]]:
        done = self._native.intervene(_given.to_json({action: keys}))
        self._keep_now()
        return done

    def add(
        self,
        positions: Any,
        group: str | None = None,
        *,
        goal: Any = None,
        velocities: Any = None,
    ) -> Added:
        """Adds people, in order, where there is room between bodies and walls.

        `positions`: an array of shape (people, 2), m. `group` is the name of the group whose profile, journey and
        traits they have: of a grid, a crowd, a source, an entrance or an agent of the scenario; it may be left out if
        there is only one. `goal`: a point [x, y] for all, or one for each, m; groups with a journey need none.
        `velocities`: of shape (people, 2), m/s, at rest if left out.

        People who are nearer to others than both may move within a frame have no room.

        Raises `Error` if a point is not on the floor, or no way leads from a position to its goal.
        """
        import numpy

        places = _points("positions", positions, None)
        count = len(places)
        keys = {"group": self._group(group), "positions": places.tolist()}
        if goal is not None:
            keys["goals"] = _points("goal", goal, count).tolist()
        if velocities is not None:
            keys["velocities"] = _points("velocities", velocities, count).tolist()
        if count == 0:
            return Added(numpy.empty(0, "int64"), numpy.empty(0, "int64"))
        ids, without_room = self._do("add", keys)
        return Added(numpy.array(ids, "int64"), numpy.array(without_room, "int64"))

    def _group(self, group: str | None) -> str:
        if group is not None:
            return group
        groups = self._native.groups
        if len(groups) == 1:
            return groups[0]
        names = ", ".join(groups) or "none: the scenario has no people"
        raise Error(f"group: say which group the people belong to; there are {names}")

    def remove(self, ids: Any) -> None:
        """Takes people out, by id. They do not count as arrived."""
        numbers = _ids(ids)
        if numbers:
            self._do("remove", numbers)

    def set_goal(self, ids: Any, goal: Any) -> None:
        """Gives people, by id, a new goal, to which they walk from the next frame on, around walls.

        `ids` is an id or a sequence of ids; `goal` a point [x, y] for all of them, or one point for each (shape
        (len(ids), 2)), m. A person on a journey leaves it, and stays at its goal. Others leave the simulation at their
        goal if their group does (`remove_within`).

        Raises `Error` if an id is not present, or a goal is not on the floor or cannot be reached. No one gets a new
        goal then.
        """
        numbers = _ids(ids)
        if numbers:
            points = _points("goal", goal, len(numbers))
            self._native.set_goals(list(zip(numbers, points.tolist())))
            self._keep_now()

    def set_journey(self, ids: Any, journey: str) -> None:
        """People, by id, begin a journey of the scenario, by name, from its first stage on."""
        numbers = _ids(ids)
        if numbers:
            self._do("set_journey", {"agents": numbers, "journey": journey})

    def set_speed(self, ids: Any, speed: Any) -> None:
        """Gives people, by id, another preferred speed, m/s: a number, or one for each. The largest speed at which they
        can move changes with it."""
        import numpy

        numbers = _ids(ids)
        speeds = numpy.asarray(speed, dtype="float64")
        if speeds.shape not in ((), (len(numbers),)):
            raise Error(f"speed: a number, or one for each of {len(numbers)} agents, not an array of shape {speeds.shape}")
        if not numbers:
            return
        self._do("set_speed", {"agents": numbers, "preferred_speeds": numpy.atleast_1d(speeds).tolist()})

    def push(
        self,
        region: Any,
        secs: float,
        *,
        goal_scale: float | None = None,
        ignore_contact: bool = False,
        ignore_sph: bool = False,
        acceleration: Any = None,
        direction: Any = None,
        name: str = "push",
    ) -> None:
        """People who are in a region at the beginning of the next frame behave differently for `secs` seconds.

        `region`: [[x, y], [x, y]], the lower left and the upper right corner, m. `goal_scale`: their K^goal.
        `acceleration`: a force from outside, over their mass: a list of [seconds since it begins, m/s²], in straight
        lines; `direction` its direction, along x if left out.
        """
        keys: dict[str, Any] = {
            "name": name,
            "region": region,
            "for_secs": secs,
            "ignore_contact": ignore_contact,
            "ignore_sph": ignore_sph,
        }
        given = {"goal_scale": goal_scale, "acceleration": acceleration, "direction": direction}
        self._do("push", keys | {key: value for key, value in given.items() if value is not None})

    def open(self, name: str) -> None:
        """Opens an exit, a door or an entrance, by name."""
        self._do("open", name)

    def close(self, name: str) -> None:
        """Closes an exit, a door or an entrance, by name: nobody passes it. People who arrive at a closed entrance wait
        before it, and enter when it opens."""
        self._do("close", name)

    def release(self, name: str) -> None:
        """Ends all waiting in a waiting area, by name, from now on."""
        self._do("release", name)

    def set_capacity(self, exit: str, most_per_sec: float | None) -> None:
        """Changes how many people per second an exit, by name, lets pass at most; `None`: no limit."""
        self._do("set_capacity", {"exit": exit, "most_per_sec": most_per_sec})

    def set_rate(self, entrance: str, per_sec: float) -> None:
        """Changes how many people per second arrive at an entrance, by name; 0: none. The entrance's `until_secs` and
        `number` still hold. Entrances with given times of arrival are random from now on."""
        self._do("set_rate", {"entrance": entrance, "per_sec": per_sec})

    def set_zone(self, zone: str, speed_factor: float) -> None:
        """Changes the factor on preferred speeds in a zone, by name: from 0.01 to 10."""
        self._do("set_zone", {"zone": zone, "speed_factor": speed_factor})

    def scenario(self) -> dict[str, Any]:
        """The scenario up to the current frame, with all that was done in `interventions`. A run of it, by
        `sandbox run` or `run`, ends in the same state: it has the same `state_sha256`."""
        if self._model is not None:
            warnings.warn(f"the scenario does not have the model {self._model.name}: give it to `run`, too", stacklevel=2)
        return json.loads(self._native.played())


def _ids(ids: Any) -> list[int]:
    import numpy

    ids = numpy.atleast_1d(numpy.asarray(ids))
    if ids.ndim != 1 or (ids.size > 0 and ids.dtype.kind not in "iu"):
        raise TypeError("ids: give an agent's id, or a sequence of ids")
    return [_given.agent_id(one) for one in ids.tolist()]


def _points(name: str, points: Any, count: int | None) -> numpy.ndarray:
    """An array of shape (`count`, 2); a single point stands for all."""
    import numpy

    try:
        points = numpy.asarray(points, dtype="float64")
    except ValueError as problem:
        raise Error(f"{name}: give a point [x, y], or one for each agent: {problem}") from None
    if points.shape == (2,) and count is not None:
        points = numpy.broadcast_to(points, (count, 2))
    if count is None and points.size == 0:
        points = points.reshape(0, 2)
    if points.ndim != 2 or points.shape[1] != 2 or count not in (None, len(points)):
        wanted = "points of shape (people, 2)" if count is None else f"a point [x, y], or one for each of {count} agents"
        raise Error(f"{name}: {wanted}, not an array of shape {points.shape}")
    return points
