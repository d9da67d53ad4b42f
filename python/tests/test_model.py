"""Models of one's own: they agree with built-in forces, act as they say, and fail with a clear error."""

import importlib.util
import json
import subprocess
import sys
import warnings
from pathlib import Path

import numpy
import pytest

import sandbox_crowds as sc

EXAMPLES = Path(__file__).parents[2] / "examples"


def example(name):
    """An example as a module."""
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def plain(seed=1, **more):
    """Two groups through each other on an open plane, with social forces alone: no walls, no contacts."""
    grid = {"columns": 12, "rows": 8, "jitter": 0.2}
    return {
        "seed": seed,
        "profile": "sf",
        "parameters": {"agent_stiffness": 0},
        "precision": "double",
        "grids": [
            grid | {"min": [0, 0], "max": [14, 9], "goal": [60, 4]},
            grid | {"min": [12, 0], "max": [26, 9], "goal": [-40, 4]},
        ],
        "time_step_secs": 0.02,
        "duration_secs": 60,
    } | more


@pytest.mark.parametrize("frames", [0, 1, 40, 200])
def test_the_social_force_in_numpy_agrees_with_the_built_in_one(frames):
    own = example("own_model")
    before = sc.Simulation(plain())
    before.step(frames)
    document = plain(grids=[])
    document["agents"] = [
        {
            "position": [row.pos_x, row.pos_y],
            "velocity": [row.vel_x, row.vel_y],
            "goal": [row.goal_x, row.goal_y],
            "radius": row.radius,
            "mass": row.mass,
        }
        for row in before.agents().itertuples()
    ]
    built_in = sc.Simulation(document)
    other = sc.Simulation(document, model=sc.Model(own.social_force, replaces=True, reach=own.RADIUS))
    accelerations = built_in.agents()[["acc_x", "acc_y"]].to_numpy()
    assert numpy.abs(accelerations).max() > 0.1
    numpy.testing.assert_allclose(other.agents()[["acc_x", "acc_y"]], accelerations, rtol=0, atol=1e-9)
    for one in (built_in, other):
        one.step(25)
    numpy.testing.assert_allclose(other.positions, built_in.positions, rtol=0, atol=1e-9)


def test_the_example_forms_lanes():
    own = example("own_model")
    run = sc.run(
        own.CORRIDOR, model=own.MODEL, profile="sf", parameters={"agent_strength": 0, "goal_scale": 0}, progress=False
    )

    without = sc.run(own.CORRIDOR, profile="sf", parameters={"agent_strength": 0}, progress=False)

    def order(run, at):
        """The order of bands by Rex and Löwen (2007): 1 if nobody has anybody from the other side beside, 0 if mixed."""
        rows = run.agents(at)
        beside = numpy.abs(rows.pos_y.to_numpy()[:, None] - rows.pos_y.to_numpy()[None]) < 0.4
        same = rows.group.to_numpy()[:, None] == rows.group.to_numpy()[None]
        numpy.fill_diagonal(beside, False)
        alike, others = (beside & same).sum(1), (beside & ~same).sum(1)
        return numpy.mean(((alike - others) / numpy.maximum(1, alike + others)) ** 2)

    assert order(run, 0) < 0.25 and order(run, 20) > 0.75 and order(run, 60) > 0.95
    assert order(without, 20) < 0.4  # people who only touch each other do not


def test_a_frame_has_everyone_and_everything_within_reach(corridor):
    seen = []

    def look(frame):
        seen.append(frame)
        return numpy.zeros_like(frame.positions)

    simulation = sc.Simulation(corridor, model=sc.Model(look, reach=1.5))
    simulation.step(30)
    frame = seen[-1]
    assert (frame.number, frame.time_step) == (30, simulation.time_step)
    assert frame.time == pytest.approx(simulation.time)
    order = numpy.argsort(frame.ids)
    numpy.testing.assert_array_equal(frame.ids[order], simulation.ids)
    numpy.testing.assert_array_equal(frame.positions[order], simulation.positions)
    numpy.testing.assert_array_equal(frame.velocities[order], simulation.velocities)
    numpy.testing.assert_array_equal(frame.densities[order], simulation.densities)
    table = simulation.agents()
    numpy.testing.assert_array_equal(frame.radii[order], table.radius)
    numpy.testing.assert_array_equal(frame.preferred_velocities[order], table[["preferred_vel_x", "preferred_vel_y"]])
    # Pairs, by brute force.
    r = frame.positions[:, None] - frame.positions[None]
    near = numpy.linalg.norm(r, axis=2) < 1.5
    numpy.fill_diagonal(near, False)
    assert set(zip(frame.first.tolist(), frame.second.tolist())) == set(zip(*map(numpy.ndarray.tolist, near.nonzero())))
    numpy.testing.assert_array_equal(frame.separations, r[frame.first, frame.second])
    assert len(frame.first) > 10 and (numpy.diff(frame.first) >= 0).all()
    # The wall below is at y = 0, that above at y = 2 up to x = 10.
    below = frame.wall_points[:, 1] == 0
    people = frame.wall_people[below]
    assert sorted(people.tolist()) == sorted(numpy.flatnonzero(frame.positions[:, 1] < 1.5).tolist())
    numpy.testing.assert_allclose(frame.wall_points[below, 0], frame.positions[people, 0], rtol=0, atol=1e-12)
    with pytest.raises(ValueError, match="read-only"):
        frame.positions[0] = 0


def test_accelerations_join_the_profile_or_replace_it(corridor):
    def lift(frame):
        return numpy.tile([0.0, 0.25], (len(frame.ids), 1))

    joined = sc.Simulation(corridor, model=sc.Model(lift, name="lift"))
    without = sc.Simulation(corridor)
    column = ["acc_x", "acc_y"]
    more = joined.agents()[column].to_numpy() - without.agents()[column].to_numpy()
    numpy.testing.assert_allclose(more, numpy.tile([0, 0.25], (8, 1)), atol=1e-12)
    assert joined.inspect(3)["own_forces"] == [{"name": "lift", "acceleration": [0.0, 0.25]}]
    assert joined.inspect(3)["profiles"]
    alone = sc.Simulation(corridor, model=sc.Model(lift, replaces=True))
    numpy.testing.assert_array_equal(alone.agents()[column], numpy.tile([0, 0.25], (8, 1)))
    assert alone.inspect(3)["profiles"] == []


def test_velocities_are_what_people_want(corridor):
    def up(frame):
        return numpy.tile([0.0, 0.3], (len(frame.ids), 1))

    simulation = sc.Simulation(corridor, model=sc.Model(up, gives="velocities"), profile="sph")
    wanted = simulation.agents()[["preferred_vel_x", "preferred_vel_y"]]
    numpy.testing.assert_array_equal(wanted, numpy.tile([0.0, 0.3], (8, 1)))
    simulation.step(60)
    assert simulation.agents().pos_y.min() > 0.9  # away from the exit's way, toward the wall


def test_a_coarse_model_is_asked_when_people_decide_and_enter(corridor):
    asked = []

    def count(frame):
        asked.append((frame.number, len(frame.ids)))
        return numpy.zeros_like(frame.positions)

    simulation = sc.Simulation(corridor, model=sc.Model(count, coarse=True), coarse_every=5)
    simulation.step(12)
    simulation.add([[9, 1]])
    simulation.step(4)
    assert asked == [(0, 8), (5, 8), (10, 8), (13, 9), (15, 9)]


def test_forks_restored_states_and_threads_have_the_same_bits():
    own = example("own_model")
    model = sc.Model(own.social_force, replaces=True, reach=own.RADIUS, coarse=True)
    simulation = sc.Simulation(plain(), model=model)
    simulation.step(33)
    others = [simulation.fork(), sc.Simulation.restore(simulation.save(), model)]
    for one in [simulation, *others]:
        one.step(40)
    assert {one.state_sha256 for one in others} == {simulation.state_sha256}
    code = (
        "import sys, json; sys.path[:0] = json.loads(sys.argv[1]); import own_model, test_model; "
        "import sandbox_crowds as sc; "
        "model = sc.Model(own_model.social_force, replaces=True, reach=own_model.RADIUS, coarse=True); "
        "s = sc.Simulation(test_model.plain(), model=model); s.step(73); print(s.state_sha256)"
    )
    paths = json.dumps([str(EXAMPLES), str(Path(__file__).parent), *sys.path])
    for threads in ("1", "3"):
        import os

        command = [sys.executable, "-c", code, paths]
        environment = os.environ | {"RAYON_NUM_THREADS": threads}
        digest = subprocess.run(command, capture_output=True, text=True, check=True, env=environment).stdout.strip()
        assert digest == simulation.state_sha256


def fails(frame):
    raise KeyError("no such thing")


@pytest.mark.parametrize(
    "function, error, message",
    [
        (fails, KeyError, "no such thing"),
        (lambda frame: [[0, 0]], sc.Error, r"it returned an array of shape \(1, 2\), not \(8, 2\)"),
        (lambda frame: frame.positions * numpy.nan, sc.Error, "for agent . is not finite"),
        (lambda frame: "fast", sc.Error, "it must return an array of numbers"),
        (lambda frame: None, sc.Error, "it returned None; is there a `return`?"),
        (lambda frame: frame.sum_over_pairs(frame.separations), sc.Error, "the model has no `reach`"),
    ],
)
def test_a_model_that_fails_is_an_error(corridor, function, error, message):
    with pytest.raises(error, match=message):
        sc.Simulation(corridor, model=sc.Model(function))


def test_a_simulation_goes_on_after_an_exception_as_without(corridor):
    asked = []

    def moody(frame):
        asked.append(frame.number)
        if len(asked) in interrupted:
            raise KeyError("later")
        return numpy.zeros_like(frame.positions)

    outcomes = []
    for interrupted in [(), (40, 41, 97)]:
        asked.clear()
        simulation = sc.Simulation(corridor, model=sc.Model(moody))
        simulation.events()
        exceptions = 0
        while simulation.frame < 400 or exceptions < len(interrupted):
            try:
                simulation.step(400 - simulation.frame)
            except KeyError:
                exceptions += 1
        told = [part.tolist() for part in simulation.events()]
        outcomes.append((simulation.state_sha256, simulation.measurements["metrics"], told))
    assert outcomes[0] == outcomes[1]


def test_settings_of_a_model_are_checked():
    for settings, message in [
        ({"gives": "forces"}, 'give "accelerations" or "velocities"'),
        ({"reach": -1}, "reach=-1"),
        ({"gives": "velocities", "replaces": True}, "replaces: is for accelerations"),
    ]:
        with pytest.raises(sc.Error, match=message):
            sc.Model(lambda frame: frame.positions, **settings)


def test_what_is_no_model_or_does_not_fit_is_an_error(corridor):
    def still(frame):
        return 0 * frame.positions

    with pytest.raises(TypeError, match=r"model: give sc.Model\(function, …\)"):
        sc.Simulation(corridor, model=still)
    with pytest.raises(TypeError, match="modle: a model is given as `model=`"):
        sc.Simulation(corridor, modle=sc.Model(still))
    ring = {"periodic": {"axis": "x", "length": 8}, "walkable_area": [[[[0, 0], [8, 0], [8, 3], [0, 3]]]]}
    ring["crowds"] = [{"area": [[0, 0], [8, 0], [8, 3], [0, 3]], "number": 5, "goal": {"direction": [1, 0]}}]
    with pytest.raises(sc.Error, match="reach=5: at most 4 m, half of the period"):
        sc.Simulation(ring, model=sc.Model(still, reach=5), profile="sf", parameters={"avoidance_radius": 3})
    with pytest.raises(sc.Error, match=r"give one vector for each of \d+ rows, not an array of shape \(8, 2\)"):
        sc.Simulation(corridor, model=sc.Model(lambda frame: frame.sum_over_pairs(frame.positions), reach=0.9))
    simulation = sc.Simulation(corridor, model=sc.Model(still, coarse=True))
    with pytest.warns(UserWarning, match="the scenario does not have the model still"):
        simulation.scenario()


def test_the_step_is_short_enough_or_a_warning_says_so(corridor):
    def spring(frame):
        return -900.0 * (frame.positions - [6, 1]) - 12.0 * frame.velocities

    simulation = sc.Simulation(corridor, model=sc.Model(spring, replaces=True))
    measured = simulation.measure_model()
    assert measured["stiffness"] == pytest.approx(900, rel=1e-3)
    assert measured["friction"] == pytest.approx(12, rel=1e-3)
    stiff = sc.Model(spring, replaces=True, **measured)
    with pytest.warns(UserWarning, match="the model spring is stable up to steps of"):
        slow = sc.Simulation(corridor, model=stiff, time_step_secs=0.1)
    with warnings.catch_warnings():
        warnings.filterwarnings("error", message="the model")
        sc.Simulation(corridor, model=stiff, time_step_secs=0.1 / numpy.ceil(0.1 / slow._native.stable_step))


def test_pictures_recordings_and_inspection_of_a_run_have_the_model(corridor, tmp_path):
    def still(frame):
        return -5 * frame.velocities

    run = sc.run(corridor, model=sc.Model(still, replaces=True, name="still"), progress=False)
    start = run.agents(0)[["pos_x", "pos_y"]].to_numpy()
    numpy.testing.assert_array_equal(run.agents(4)[["pos_x", "pos_y"]], start)
    assert run.inspect(2, at=1.0)["own_forces"][0]["name"] == "still"
    picture = tmp_path / "still.svg"
    run.draw(at=4, out=picture)
    assert "8 agents" in picture.read_text()
    with pytest.raises(sc.Error, match="exists; give force=True"):
        run.draw(at=4, out=picture)
    run.draw(at=4, out=picture, force=True)
    page = tmp_path / "still.html"
    for force in (False, True):
        run.save(page, force=force)
    recording = tmp_path / "still.rrd"
    run.save(recording)
    with pytest.raises(sc.Error, match="exists; give force=True"):
        run.save(recording)
    command = [sys.executable, "-m", "sandbox_crowds", "draw", str(recording), "--json", "-o", str(tmp_path / "a.svg")]
    subprocess.run(command, check=True, capture_output=True)
    with pytest.raises(sc.Error, match="the program does not know the model"):
        run.save(tmp_path / "still.txt")


def test_what_is_played_can_be_recorded(corridor, tmp_path):
    simulation = sc.Simulation(corridor)
    file = tmp_path / "played.rrd"
    with simulation.record(file, every=2):
        simulation.step(50)
        simulation.remove(0)
        simulation.step(50)
    picture = tmp_path / "end.svg"
    command = [sys.executable, "-m", "sandbox_crowds", "draw", str(file), "--at", "1.9", "-o", str(picture)]
    subprocess.run(command, check=True, capture_output=True)
    assert "7 agents" in picture.read_text()


def test_events_are_what_trajectories_say(corridor):
    corridor["waypoints"] = [{"name": "line", "line": [[6, 0], [6, 2]]}]
    corridor["doors"] = []
    simulation = sc.Simulation(corridor)
    first = simulation.events()
    assert [len(part) for part in first] == [0, 0, 0, 0, 0]
    before, crossed, left = simulation.agents().set_index("id"), [], []
    events = []
    for _ in range(40):
        for _ in range(20):
            simulation.step()
            now = simulation.agents().set_index("id")
            for one in now.index.intersection(before.index):
                a, b = before.loc[one], now.loc[one]
                if (a.pos_x < 6) != (b.pos_x < 6):
                    crossed.append((one, simulation.places.index("line")))
            left += [(one, simulation.places.index("end")) for one in before.index.difference(now.index)]
            before = now
        events.append(simulation.events())
    told = numpy.concatenate([part.crossed for part in events])
    assert sorted(zip(told["id"].tolist(), told["place"].tolist())) == sorted(crossed) and len(crossed) == 8
    assert (told["direction"] == told["direction"][0]).all() and abs(told["direction"][0]) == 1
    gone = numpy.concatenate([part.left for part in events])
    assert sorted(zip(gone["id"].tolist(), gone["place"].tolist())) == sorted(left) and len(left) == 8
    assert (numpy.abs(gone["y"] - 10) < 0.1).all()
    simulation.add([[1, 1]])
    simulation.step(1)
    entered = simulation.events().entered
    assert entered["id"].tolist() == [8] and abs(entered["x"][0] - 1) < 0.1


def test_the_gate_is_an_environment_and_forks_find_the_better_action():
    checker = pytest.importorskip("gymnasium.utils.env_checker")
    gate = example("gate_env")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        checker.check_env(gate.GateEnv(secs=5), skip_render_check=True)
    totals = {}
    for name, choose in [("open", lambda environment: 1), ("ahead", gate.GateEnv.look_ahead)]:
        environment, over, totals[name] = gate.GateEnv(), False, 0.0
        seen, _ = environment.reset()
        while not over:
            seen, reward, _, over, facts = environment.step(choose(environment))
            places = environment.simulation.positions
            inside = sum(8 <= x <= 12 and 2 <= y <= 6 for x, y in places)
            assert seen[0] == inside / 16 and seen[1] == len(places)
            assert reward == facts["left"] - max(0, seen[0] - 2.5)
            totals[name] += reward
    assert totals["ahead"] > totals["open"] + 2
