"""Random calls with wrong types, shapes and values raise exceptions; memory does not grow."""

import gc
import random
import sys
import warnings

import numpy
import pytest

import sandbox_crowds as sc
from sandbox_crowds import _study

CALLS = 10_000


def strange(rng, depth=0):
    """Any value."""
    values = [
        None, True, False, 0, 1, -1, 3, 2**31, 2**63, 2**64, -(2**70), 0.0, -0.0, 0.5, 1e-300, 1e300,
        float("nan"), float("inf"), -float("inf"), 1j, "", "evacuation", "17", "sph", "\x00", "\ud800", "–" * 50,
        b"", b"\xff", object(), int, len, [], {}, (), set(), range(3), [[]], [0, 1], [1.0, 1.0], [[1, 1], [2, 1]],
        {"x": 1}, {1: 2}, [float("nan"), 0], numpy.zeros(2), numpy.zeros((0, 2)), numpy.zeros((3, 2)),
        numpy.arange(4), numpy.arange(4.0), numpy.array("x"), numpy.array(None), numpy.uint32(2), numpy.float32(2),
        numpy.ones((2, 2, 2)), numpy.array([True, False]), numpy.datetime64("2020-01-01"), slice(1), Ellipsis,
        NotImplemented, RuntimeError("x"), lambda: 0, iter([1]), bytearray(4), memoryview(b"abc"),
    ]  # fmt: skip
    kind = rng.random()
    if depth < 3 and kind < 0.15:
        return [strange(rng, depth + 1) for _ in range(rng.randrange(4))]
    if depth < 3 and kind < 0.25:
        return {str(rng.choice(KEYS)): strange(rng, depth + 1) for _ in range(rng.randrange(3))}
    if kind < 0.35:
        return rng.uniform(-20, 20)
    return rng.choice(values)


KEYS = [
    "seed", "duration_secs", "profile", "viscosity", "grids", "goal", "obstacles", "walkable_area", "exits",
    "measurements", "time_step_secs", "stop", "view", "parameters", "name", "nonsense", "grids.0.rows", "", ".", "until",
    "time_step", "preset", "crowds", "sources", "from", "navigation", "columns", "fps", "geometry",
]  # fmt: skip


def document(rng, corridor):
    """A scenario with a few strange values."""
    changed = dict(corridor)
    for _ in range(rng.randrange(1, 3)):
        changed[rng.choice(KEYS)] = strange(rng)
    return changed


def call(rng, simulation, run, corridor):
    """A random call with strange arguments. Nothing that works takes long."""
    short = {"until": 0.1}
    settings = {rng.choice(KEYS): strange(rng)}
    choice = rng.randrange(16)
    if choice == 0:
        sc.Simulation(strange(rng))
    elif choice in (1, 2):
        sc.Simulation(document(rng, corridor))
    elif choice in (3, 4):
        sc.run(corridor, progress=False, **(short | settings | {"columns": ["frame"]}))
    elif choice == 5:
        sc.run(corridor, progress=False, fps=strange(rng), **short)
    elif choice == 6:
        sc.run(corridor, progress=False, columns=strange(rng), **short)
    elif choice == 7:
        frames = strange(rng)
        try:
            if frames > 1000:
                frames = 3
        except (TypeError, ValueError):
            pass
        simulation.step(frames)
    elif choice in (8, 9):
        simulation.set_goal(strange(rng), strange(rng))
    elif choice == 10:
        simulation.set_goal(rng.choice([0, [0, 1], [7, 7], simulation.ids]), strange(rng))
    elif choice == 11:
        simulation.inspect(strange(rng))
    elif choice == 12:
        run.agents(strange(rng))
    elif choice == 13:
        setattr(simulation, rng.choice(["frame", "positions", "time"]), strange(rng))
    elif choice == 14:
        _study._with_files(document(rng, {"scenario": corridor}), strange(rng))
    else:
        sc.Simulation(corridor, geometry=strange(rng), **settings)


def test_random_calls_raise_exceptions_and_never_panic(corridor):
    rng = random.Random(1)
    simulation = sc.Simulation(corridor)
    run = sc.run(corridor, progress=False)
    raised = 0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for k in range(CALLS):
            try:
                call(rng, simulation, run, corridor)
            except Exception as error:  # PanicException is none
                raised += 1
                assert type(error).__name__ != "SystemError", (k, error)
            if k % 500 == 0:
                simulation = sc.Simulation(corridor)
    assert raised > CALLS / 2
    simulation.step()
    assert numpy.isfinite(simulation.positions).all()


@pytest.mark.parametrize(
    "use",
    [
        lambda run: run.draw(at="soon"),
        lambda run: run.draw(color="no such column"),
        lambda run: run.draw(nonsense=3),
        lambda run: run.draw(out="\x00"),
        lambda run: run.draw(out=3),
        lambda run: run.save("run.xyz"),
        lambda run: run.save("no/such/folder/run.rrd"),
        lambda run: run.inspect("x", at=0),
        lambda run: run.inspect(0, at=-5),
        lambda run: sc.sweep(3),
        lambda run: sc.sweep({"scenario": 3}),
        lambda run: sc.sweep({"scenario": "evacuation", "grid": {"viscosity": [float("inf")]}}),
        lambda run: sc.validate("--out"),
        lambda run: sc.validate(profile="unknown"),
    ],
)
def test_wrong_options_of_the_program_raise_its_messages(corridor, use):
    with pytest.raises((ValueError, TypeError)):
        use(sc.run(corridor, until=0.1, progress=False))


def resident():
    """Resident memory, bytes."""
    with open("/proc/self/statm") as file:
        return 4096 * int(file.read().split()[1])


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_memory_does_not_grow_over_a_thousand_simulations(corridor):
    def use():
        simulation = sc.Simulation(corridor)
        simulation.step(5)
        simulation.positions, simulation.densities
        simulation.set_goal(simulation.ids, [11, 9])
        run = sc.run(corridor, until=0.2, progress=False)
        run.agents(at=0.1), run.measurements

    for _ in range(100):
        use()
    gc.collect()
    before = resident()
    for _ in range(1000):
        use()
    gc.collect()
    grown = resident() - before
    # A leak of one simulation or run (more than 20 kB each) would be 20 MB.
    assert grown < 8e6, f"{grown / 1e6:.1f} MB more"
