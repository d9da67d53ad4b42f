"""Forks, saved states and going back: all go on to the same bits."""

import json
import random
import subprocess
import sys

import numpy
import pytest

import sandbox_crowds as sc


def program(simulation, seed, rounds=6):
    """Steps and new goals by chance, the same for the same seed."""
    chance = random.Random(seed)
    for _ in range(rounds):
        simulation.step(chance.randrange(1, 40))
        ids = simulation.ids
        if len(ids) and chance.random() < 0.7:
            some = chance.sample(ids.tolist(), min(3, len(ids)))
            simulation.set_goal(some, [chance.uniform(1, 9), chance.uniform(0.5, 1.5)])


@pytest.mark.parametrize("seed", range(8))
def test_forks_and_saved_states_go_on_as_the_original(corridor, seed):
    simulation = sc.Simulation(corridor)
    program(simulation, seed)
    fork, saved = simulation.fork(), simulation.save()
    restored = sc.Simulation.restore(saved)
    for copy in (fork, restored):
        assert (copy.frame, copy.time) == (simulation.frame, simulation.time)
        assert copy.state_sha256 == simulation.state_sha256
        numpy.testing.assert_array_equal(copy.densities, simulation.densities)
    for one in (simulation, fork, restored):
        program(one, seed + 100)
    assert fork.state_sha256 == simulation.state_sha256
    assert restored.state_sha256 == simulation.state_sha256
    assert fork.measurements["metrics"] == simulation.measurements["metrics"]
    assert restored.measurements["metrics"] == simulation.measurements["metrics"]


def test_what_is_done_to_a_fork_does_not_change_its_original(corridor):
    simulation, alone = sc.Simulation(corridor), sc.Simulation(corridor)
    for one in (simulation, alone):
        one.step(30)
    fork = simulation.fork()
    fork.set_goal(fork.ids, [1, 1])
    fork.step(100)
    for one in (simulation, alone):
        one.step(100)
    assert simulation.state_sha256 == alone.state_sha256 != fork.state_sha256


def test_a_new_goal_is_part_of_what_is_saved(corridor):
    simulation = sc.Simulation(corridor)
    simulation.step(25)
    simulation.set_goal([0, 1, 2], [2, 1])
    restored = sc.Simulation.restore(simulation.save())
    for one in (simulation, restored):
        one.step(200)
    assert restored.state_sha256 == simulation.state_sha256
    assert numpy.linalg.norm(restored.positions[:3] - [2, 1], axis=1).max() < 1


def test_one_can_go_back_and_do_otherwise(corridor):
    simulation = sc.Simulation(corridor)
    digests = {}
    simulation.keep(every=0.5, most=20)
    for k in range(150):
        if k == 70:
            simulation.set_goal([0, 1], [2, 1])
        digests[simulation.frame] = simulation.state_sha256
        simulation.step()
    frame = simulation.frame
    # Before and after the new goal, at snapshots and between them.
    for target in (149, 101, 71, 70, 26, 25, 3, 0):
        fork = simulation.fork()
        fork._kept = simulation._kept.copy()
        fork._every = simulation._every
        fork.rewind((frame - target) * simulation.time_step)
        assert fork.frame == target
        assert fork.state_sha256 == digests[target]
    simulation.rewind(0.5)
    assert simulation.frame == frame - round(0.5 / simulation.time_step)
    assert simulation.state_sha256 == digests[simulation.frame]


@pytest.mark.parametrize(
    ("act", "message"),
    [
        (lambda one: one.rewind(1), "call keep"),
        (lambda one: one.keep(every=0), "above 0"),
        (lambda one: one.keep(every=float("inf")), "finite"),
        (lambda one: (one.keep(), one.rewind(float("inf"))), "finite"),
        (lambda one: (one.keep(), one.rewind(-1)), "from 0 on"),
        (lambda one: (one.keep(), one.rewind(9)), "the first snapshot"),
        (lambda one: (one.keep(), one.rewind(float("nan"))), "finite number from 0 on"),
        (lambda one: sc.Simulation.restore(b"x"), "not a checkpoint"),
        (lambda one: sc.Simulation.restore(one.save()[:-3]), "damaged"),
    ],
)
def test_what_cannot_be_done_is_said(corridor, act, message):
    simulation = sc.Simulation(corridor)
    with pytest.raises(sc.Error, match=message):
        act(simulation)


def test_the_program_goes_on_from_saved_bytes_and_python_from_a_checkpoint(corridor, tmp_path):
    simulation = sc.Simulation(corridor)
    simulation.step(20)
    simulation.set_goal([0, 1], [2, 1])
    file = tmp_path / "saved.checkpoint"
    file.write_bytes(simulation.save())
    command = [sys.executable, "-m", "sandbox_crowds", "resume", str(file), "--json"]
    resumed = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    while simulation.end is None:
        simulation.step()
    assert resumed["state_sha256"] == simulation.state_sha256
    assert resumed["metrics"] == simulation.measurements["metrics"]

    scenario = tmp_path / "corridor.json"
    scenario.write_text(json.dumps(corridor))
    kept = tmp_path / "kept.checkpoint"
    run = [sys.executable, "-m", "sandbox_crowds", "run", str(scenario), "--json", "--until", "2"]
    subprocess.run([*run, "--checkpoint", str(kept)], check=True, capture_output=True)
    restored = sc.Simulation.restore(kept.read_bytes())
    alone = sc.Simulation(corridor)
    alone.step(restored.frame)
    assert restored.state_sha256 == alone.state_sha256
