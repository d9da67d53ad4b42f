"""Models of one's own."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from ._native import Error

if TYPE_CHECKING:
    import numpy


class Frame(NamedTuple):
    """One frame, as a model sees it. All arrays are read-only. Rows are people, in an order that changes from frame to
    frame: `ids` says who they are."""

    number: int
    """The number of the frame, from 0."""
    time: float
    """s."""
    time_step: float
    """The time between two frames, s."""
    ids: numpy.ndarray
    """int64 of shape (people,)."""
    positions: numpy.ndarray
    """m: float64 of shape (people, 2)."""
    velocities: numpy.ndarray
    """m/s: float64 of shape (people, 2)."""
    radii: numpy.ndarray
    """m: float64 of shape (people,)."""
    masses: numpy.ndarray
    """1 for an average person: float64 of shape (people,)."""
    preferred_velocities: numpy.ndarray
    """The velocities at which people would walk if nobody were in their way, around walls, m/s: float64 of shape
    (people, 2)."""
    densities: numpy.ndarray
    """By SPH, P/m²: float64 of shape (people,)."""
    goals: numpy.ndarray
    """m: float64 of shape (people, 2)."""
    first: numpy.ndarray
    """Pairs of people nearer than `reach`, each in both orders: the row of the one, int64 of shape (pairs,),
    ascending."""
    second: numpy.ndarray
    """The row of the other: int64 of shape (pairs,)."""
    separations: numpy.ndarray
    """From the other to the one, m: float64 of shape (pairs, 2); also across the ends of periodic scenes."""
    wall_people: numpy.ndarray
    """Walls nearer than `reach`: the row of the person, int64 of shape (walls near people,), ascending."""
    wall_points: numpy.ndarray
    """The point of the wall that is nearest to the person, m: float64 of shape (walls near people, 2)."""

    def sum_over_pairs(self, values: numpy.ndarray) -> numpy.ndarray:
        """The sum of vectors of pairs for each person: shape (pairs, 2) becomes (people, 2)."""
        return _sums(self.first, values, len(self.ids))

    def sum_over_walls(self, values: numpy.ndarray) -> numpy.ndarray:
        """The sum of vectors of walls for each person: shape (walls near people, 2) becomes (people, 2)."""
        return _sums(self.wall_people, values, len(self.ids))


class Model:
    """A model of one's own: a function that gets a `Frame` and returns an array of shape (people, 2).

    It is called once per frame, or with `coarse` only when people decide (`coarse_every`) and when people enter between;
    its vectors are held until then. It must depend on the frame alone: then forks and restored states go on to the same
    bits, on any number of threads.
    """

    def __init__(
        self,
        function: Callable[[Frame], Any],
        *,
        gives: str = "accelerations",
        replaces: bool = False,
        coarse: bool = False,
        reach: float = 0.0,
        stiffness: float = 0.0,
        friction: float = 0.0,
        name: str | None = None,
    ) -> None:
        """`gives`: `"accelerations"`, m/s², which join those of the people's profiles, or with `replaces` take their
        place; or `"velocities"`, m/s, that people want, in place of those toward their goals: all forces of the profiles
        act on, and steer toward them.

        `reach`: the distance up to which the function needs other people and walls, m.

        `stiffness` (1/s²) and `friction` (1/s) say how steep the accelerations are: the largest change of an
        acceleration per meter and per m/s, as K/m of the spring of a contact. The step must be short enough for them: a
        warning says if it is not. `Simulation.measure_model()` measures both in the current frame.
        """
        if not callable(function):
            raise TypeError("function: give a function of a frame")
        if gives not in ("accelerations", "velocities"):
            raise Error(f'gives={gives!r}: give "accelerations" or "velocities"')
        if replaces and gives == "velocities":
            raise Error("replaces: is for accelerations; velocities are always in place of those toward goals")
        for key, value in [("reach", reach), ("stiffness", stiffness), ("friction", friction)]:
            if not 0 <= value < math.inf:
                raise Error(f"{key}={value}: give a finite number from 0 on")
        if reach > 100:
            raise Error(f"reach={reach}: at most 100 m")
        self.function = function
        self.gives = gives
        self.replaces = replaces
        self.coarse = coarse
        self.reach = float(reach)
        self.stiffness = float(stiffness)
        self.friction = float(friction)
        self.name = name or getattr(function, "__name__", "model")

    def _given(self) -> dict[str, Any]:
        return {
            "function": self._call,
            "name": self.name,
            "gives": "all accelerations" if self.replaces else self.gives,
            "coarse": bool(self.coarse),
            "reach": self.reach,
            "stiffness": self.stiffness,
            "friction": self.friction,
        }

    def _call(self, time: tuple[int, float, float], people: list[Any], around: list[Any]) -> bytes:
        return self._vectors(frame_of(time, people, around, self.reach)).tobytes()

    def _vectors(self, frame: Frame) -> numpy.ndarray:
        import numpy

        given = self.function(frame)
        if given is None:
            raise Error(f"the model {self.name}: it returned None; is there a `return`?")
        try:
            vectors = numpy.ascontiguousarray(given, dtype="float64")
        except (TypeError, ValueError) as problem:
            raise Error(f"the model {self.name}: it must return an array of numbers: {problem}") from None
        wanted = (len(frame.ids), 2)
        if vectors.shape != wanted:
            raise Error(f"the model {self.name}: it returned an array of shape {vectors.shape}, not {wanted}")
        return vectors


class _WithoutReach:
    """Stands for pairs and walls of a model without a reach: any use of it is an error."""

    def _refuse(self, *_: Any, **__: Any) -> Any:
        raise Error("the model has no `reach`, so it gets no pairs and walls: give sc.Model(function, reach=…), m")

    __array__ = __getitem__ = __iter__ = __len__ = _refuse

    def __getattr__(self, name: str) -> Any:
        self._refuse()


def frame_of(
    time: tuple[int, float, float], people: list[Any], around: list[Any], reach: float
) -> Frame:
    import numpy

    def array(data: Any, kind: str, *shape: int) -> numpy.ndarray:
        values = numpy.frombuffer(data, dtype=kind)
        values.flags.writeable = False
        return values.reshape(shape) if shape else values

    ids, positions, velocities, radii, masses, preferred, densities, goals = people
    kinds = [("int64",), ("int64",), ("float64", -1, 2), ("int64",), ("float64", -1, 2)]
    near: list[Any] = [array(data, *kind) for data, kind in zip(around, kinds)]
    if reach == 0:
        near = [_WithoutReach()] * len(near)
    return Frame(
        *time,
        ids=array(ids, "int64"),
        positions=array(positions, "float64", -1, 2),
        velocities=array(velocities, "float64", -1, 2),
        radii=array(radii, "float64"),
        masses=array(masses, "float64"),
        preferred_velocities=array(preferred, "float64", -1, 2),
        densities=array(densities, "float64"),
        goals=array(goals, "float64", -1, 2),
        first=near[0],
        second=near[1],
        separations=near[2],
        wall_people=near[3],
        wall_points=near[4],
    )


def _sums(rows: numpy.ndarray, values: numpy.ndarray, count: int) -> numpy.ndarray:
    import numpy

    values = numpy.asarray(values, dtype="float64")
    if values.shape != (len(rows), 2):
        raise Error(f"sums: give one vector for each of {len(rows)} rows, not an array of shape {values.shape}")

    x = numpy.bincount(rows, weights=values[:, 0], minlength=count)
    y = numpy.bincount(rows, weights=values[:, 1], minlength=count)
    return numpy.stack([x, y], axis=1)


def measured(model: Model, frame: Frame) -> tuple[float, float]:
    """The stiffness, 1/s², and friction, 1/s, of a model in a frame: the largest changes of its accelerations with
    positions and velocities, by power iteration with small changes of all people at once."""
    import numpy

    if len(frame.ids) == 0:
        return 0.0, 0.0
    base = model._vectors(frame)

    def largest(changed: Callable[[numpy.ndarray], Frame], size: float) -> float:
        way = numpy.random.default_rng(1).normal(size=base.shape)
        rate = 0.0
        for _ in range(30):
            way /= numpy.linalg.norm(way)
            change = (model._vectors(changed(size * way)) - base) / size
            rate = float(numpy.linalg.norm(change))
            if rate == 0.0:
                break
            way = change / rate
        return rate

    def moved(by: numpy.ndarray) -> Frame:
        if model.reach == 0:
            return frame._replace(positions=frame.positions + by)
        return frame._replace(
            positions=frame.positions + by,
            separations=frame.separations + by[frame.first] - by[frame.second],
        )

    def faster(by: numpy.ndarray) -> Frame:
        return frame._replace(velocities=frame.velocities + by)

    return largest(moved, 1e-5), largest(faster, 1e-5)


def warn_of_step(native: Any, model: Model | None) -> None:
    """Warns if the step is too long for a model."""
    stable = native.stable_step
    if model is not None and stable is not None and native.time_step > stable * (1 + 1e-9):
        step = 0.1 / math.ceil(0.1 / stable)  # pictures and trajectories have whole frames per 0.1 s
        warnings.warn(
            f"the model {model.name} is stable up to steps of {stable:g} s, and the step is {native.time_step:g} s: set "
            f"time_step_secs={step:g}",
            stacklevel=4,
        )
