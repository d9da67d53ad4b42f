"""Simulations step by step: reading, steering, interrupts."""

import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy
import pytest

import sandbox_crowds as sc


def test_arrays_have_one_row_per_agent_by_id(corridor):
    simulation = sc.Simulation(corridor)
    simulation.step(50)
    assert simulation.frame == 50
    assert simulation.time == pytest.approx(50 * simulation.time_step)
    assert simulation.ids.tolist() == list(range(8)) and len(simulation) == 8
    assert simulation.positions.shape == simulation.velocities.shape == (8, 2)
    assert simulation.densities.shape == (8,)
    agents = simulation.agents()
    numpy.testing.assert_array_equal(agents[["pos_x", "pos_y"]], simulation.positions)
    numpy.testing.assert_array_equal(agents[["vel_x", "vel_y"]], simulation.velocities)
    numpy.testing.assert_array_equal(agents["density"], simulation.densities)


def test_arrays_are_copies(corridor):
    simulation = sc.Simulation(corridor)
    positions = simulation.positions
    positions += 100
    simulation.step()
    assert simulation.positions.max() < 13


def test_reading_changes_nothing_and_steps_add_up(corridor):
    whole = sc.run(corridor).measurements
    simulation = sc.Simulation(corridor)
    while simulation.end is None:
        simulation.step(7 if simulation.frame + 7 <= whole["frames"] else 1)
        simulation.positions, simulation.densities, simulation.inspect(0)
    assert simulation.state_sha256 == whole["state_sha256"]
    assert simulation.measurements["metrics"] == whole["metrics"]


def test_agents_walk_to_new_goals_around_walls(corridor):
    del corridor["exits"]
    corridor["goal"] = [9, 1]
    simulation = sc.Simulation(corridor)
    simulation.step(50)
    simulation.set_goal(simulation.ids[:4], [11, 9])
    simulation.set_goal(5, (1, 1))
    simulation.step(1000)
    positions = simulation.positions
    assert numpy.linalg.norm(positions[:4] - [11, 9], axis=1).max() < 1
    assert numpy.linalg.norm(positions[5] - [1, 1]) < 0.5


def test_goals_may_differ_and_the_same_goals_give_the_same_bits(corridor):
    def steered():
        simulation = sc.Simulation(corridor)
        for _ in range(20):
            simulation.step(10)
            simulation.set_goal(simulation.ids, simulation.positions[::-1].copy())
        return simulation.state_sha256

    assert steered() == steered()


@pytest.mark.parametrize(
    ("ids", "goal", "message"),
    [
        (99, [1, 1], "agent 99: not present at 0.00 s"),
        (0, [5, 5], "lies in an obstacle or outside of the walkable area"),
        (0, [float("nan"), 1], "outside of the walkable area"),
        ([0, 1], [[1, 1]], "goal: a point"),
    ],
)
def test_errors_of_goals(corridor, ids, goal, message):
    simulation = sc.Simulation(corridor)
    with pytest.raises(sc.Error) as error:
        simulation.set_goal(ids, goal)
    assert message in str(error.value)


def test_no_agents_need_no_goal(corridor):
    simulation = sc.Simulation(corridor)
    before = simulation.state_sha256
    simulation.set_goal([], [])
    assert simulation.state_sha256 == before


@pytest.mark.parametrize("agent", [-1, 2**40, 2**70])
def test_ids_are_whole_numbers_from_0(corridor, agent):
    with pytest.raises(sc.Error, match="ids are whole numbers from 0"):
        sc.Simulation(corridor).inspect(agent)


def test_a_forked_process_is_refused_instead_of_waiting_forever():
    script = """
        import os
        import sandbox_crowds as sc
        sc.run("evacuation", until=0.1)
        child = os.fork()
        if child == 0:
            try:
                sc.run("evacuation", until=0.1)
            except sc.Error as error:
                os._exit(7 if "spawn" in str(error) else 1)
            os._exit(0)
        raise SystemExit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
        """
    code = [sys.executable, "-W", "ignore", "-c", textwrap.dedent(script)]
    assert subprocess.run(code, timeout=60).returncode == 7


def test_forces_sum_up_to_the_acceleration(corridor):
    simulation = sc.Simulation(corridor)
    simulation.step(100)
    found = simulation.inspect(2)
    total = sum(
        share["weight"] * numpy.sum(list(share["accelerations"].values()), axis=0) for share in found["profiles"]
    )
    numpy.testing.assert_allclose(total, found["acceleration"], atol=1e-3)


def test_other_threads_run_during_a_step():
    simulation = sc.Simulation("evacuation")
    begun, ran = threading.Event(), threading.Event()

    def other():
        begun.wait()
        ran.set()

    thread = threading.Thread(target=other)
    thread.start()
    interval = sys.getswitchinterval()
    # From here on, the other thread runs only where this one gives up Python's lock by itself.
    sys.setswitchinterval(1000)
    try:
        begun.set()
        for _ in range(1000):
            simulation.step(100)
            if ran.is_set():
                break
        assert ran.is_set()
    finally:
        sys.setswitchinterval(interval)
        thread.join()


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_ctrl_c_interrupts_and_the_simulation_goes_on():
    # Processes that a shell starts in the background ignore Ctrl-C unless they say otherwise.
    code = """
        import signal
        import sandbox_crowds as sc
        signal.signal(signal.SIGINT, signal.default_int_handler)
        simulation = sc.Simulation("evacuation")
        print("ready", flush=True)
        try:
            simulation.step(10**9)
        except KeyboardInterrupt:
            before = simulation.frame
            simulation.step(2)
            print("interrupted", simulation.frame - before)
    """
    process = subprocess.Popen([sys.executable, "-c", textwrap.dedent(code)], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    said, _ = process.communicate(timeout=60)
    assert said == "interrupted 2\n"


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_ctrl_c_ends_the_program_with_130(tmp_path):
    # A run of days; it handles signals before it writes.
    long = '{"duration_secs": 1e6, "agents": [{"position": [0, 0], "goal": [9, 0]}]}'
    (tmp_path / "long.json").write_text(long)
    written = tmp_path / "long.csv"
    arguments = ["run", tmp_path / "long.json", "--trajectory", written, "--json"]
    process = subprocess.Popen(
        [sys.executable, "-m", "sandbox_crowds", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    while process.poll() is None and not (written.exists() and written.stat().st_size > 0):
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    said, messages = process.communicate(timeout=60)
    assert process.returncode == 130
    assert '"interrupted":true' in said
    assert "Traceback" not in messages
