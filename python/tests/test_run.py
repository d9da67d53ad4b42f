"""Whole runs: results, pictures, files, PedPy."""

import json
import re
import subprocess
import sys

import numpy
import pandas
import pytest

import sandbox_crowds as sc


def program(*words):
    return subprocess.run(
        [sys.executable, "-m", "sandbox_crowds", *map(str, words)],
        capture_output=True,
        text=True,
        check=True,
    ).stdout


def test_a_run_has_the_results_of_the_program():
    run = sc.run("evacuation", until=3, viscosity=5)
    said = program("evacuation", "--until", 3, "--set", "viscosity=5", "--json")
    said = json.loads(said)
    for key in ("state_sha256", "identity", "metrics", "settings", "frames"):
        assert run.measurements[key] == said[key], key


def test_the_trajectory_has_the_columns_and_digits_of_a_csv_file(tmp_path, corridor):
    run = sc.run(corridor, fps=5)
    run.save(tmp_path / "run.csv", trajectory_fps=5)
    read = pandas.read_csv(tmp_path / "run.csv")
    legs = {"legs_x", "legs_y", "legs_vel_x", "legs_vel_y", "lean"}
    assert list(read) == [name for name in sc.columns() if name not in legs]
    assert list(run.trajectory) == list(read)
    for name in read:
        ours = run.trajectory[name]
        if ours.dtype.kind in "uf":
            numpy.testing.assert_array_equal(ours, read[name], err_msg=name)
        else:
            assert [str(one) for one in ours] == [str(one) for one in read[name]], name


def test_agents_of_a_time_are_those_of_the_nearest_frame(corridor):
    run = sc.run(corridor)
    agents = run.agents(at=2.04)
    assert set(agents["time"]) == {2.0}
    assert list(agents["id"]) == sorted(agents["id"]) and len(agents) == 8
    with pytest.raises(sc.Error, match="the run ended at 4.00 s"):
        run.agents(at=5)


def test_columns_can_be_chosen(corridor):
    run = sc.run(corridor, columns=["pos_x", "frame"])
    assert list(run.trajectory) == ["frame", "pos_x"]
    with pytest.raises(sc.Error, match="no column `speeed`"):
        sc.run(corridor, columns=["speeed"])


def test_pedpy_takes_the_trajectories(corridor):
    pedpy = pytest.importorskip("pedpy")
    data, area = sc.run(corridor).to_pedpy()
    assert data.frame_rate == 10
    assert area.polygon.area >= 40.0
    speeds = pedpy.compute_individual_speed(traj_data=data, frame_step=5)
    assert 0.5 < speeds.speed.mean() < 2.0


def test_a_run_can_be_drawn_saved_and_inspected(tmp_path, corridor):
    run = sc.run(corridor)
    assert run.draw(at=1, color="speed")._repr_png_().startswith(b"\x89PNG")
    run.draw(at=1, out=tmp_path / "run.svg")
    assert "<svg" in (tmp_path / "run.svg").read_text()
    run.save(tmp_path / "run.rrd", record_every=25)
    # Everybody is in the recording.
    picture = tmp_path / "recorded.svg"
    program("draw", tmp_path / "run.rrd", "--at", 1, "--out", picture)
    places = set(re.findall(r'<circle cx="(\d+)" cy="(\d+)"', picture.read_text()))
    assert len(places) == (run.trajectory.frame == 10).sum()
    with pytest.raises(sc.Error, match="already exists"):
        run.save(tmp_path / "run.rrd")
    found = run.inspect(3, at=1)
    assert found["id"] == 3 and found["profiles"]


def test_settings_are_keys_of_the_scenario(corridor):
    run = sc.run(corridor, until=1, seed=7, profile="rvo", **{"grids.0.rows": 1})
    found = run.measurements
    assert (found["time_secs"], found["seed"], found["agents"]) == (1.0, 7, 4)
    assert found["profile"] == "rvo"


def test_numbers_of_numpy_are_numbers(corridor):
    corridor["grids"][0]["max"] = numpy.array([4.0, 1.5])
    run = sc.run(corridor, until=numpy.float64(0.5), seed=numpy.int64(3))
    assert run.measurements["seed"] == 3


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"viscosty": 5}, "unknown setting `viscosty`; did you mean `viscosity`"),
        ({"viscosity": -5}, "viscosity=-5"),
        ({"viscosity": "5"}, "viscosity"),
        ({"until": 5, "duration_secs": 6}, "set the same key"),
        ({"geometry": "no/such.wkt"}, "geometry=no/such.wkt: cannot be read"),
        ({"fps": 7}, "fps: 7 frames per second do not divide"),
    ],
)
def test_errors_are_those_of_the_program(settings, message):
    with pytest.raises(sc.Error) as error:
        sc.run("evacuation", **settings)
    assert message in str(error.value)


def test_values_that_are_not_json_are_errors(corridor):
    with pytest.raises(ValueError, match="JSON"):
        sc.run(corridor | {"goal": [float("nan"), 1]})
    with pytest.raises(TypeError, match="not JSON"):
        sc.run(corridor | {"goal": object()})
    with pytest.raises(sc.Error, match="no/such.json"):
        sc.run("no/such.json")


def test_trajectories_that_do_not_fit_into_memory_are_refused():
    with pytest.raises(sc.Error, match="would take .* of memory"):
        sc.run("concert", until=1e6, fps=50)


def test_a_sweep_is_a_table(corridor):
    study = {"scenario": corridor, "grid": {"preferred_speed": [1.0, 1.5]}, "seeds": 2}
    table = sc.sweep(study, progress=False)
    assert len(table) == 4
    assert set(table["status"]) == {"finished"}
    assert list(table["preferred_speed"]) == [1.0, 1.0, 1.5, 1.5]
    with pytest.raises(sc.Error, match="seeds"):
        sc.sweep(study | {"seeds": -1})


def test_scenarios_of_a_sweep_have_their_names_and_find_their_files(tmp_path, corridor, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plan.wkt").write_text("POLYGON ((0 0, 12 0, 12 10, 10 10, 10 2, 0 2))")
    own = corridor | {"name": "my corridor", "walkable_area": "plan.wkt"}
    table = sc.sweep({"list": [{"scenario": own, "label": "one"}]}, progress=False)
    assert table["scenario"].tolist() == ["my corridor"] and table["status"].tolist() == ["finished"]


def test_times_may_be_numbers_of_numpy(corridor):
    run = sc.run(corridor)
    one = run.agents(1)
    for at in [numpy.int64(1), numpy.float32(1), numpy.float64(1)]:
        assert run.agents(at).equals(one)
    with pytest.raises(sc.Error, match="not a time"):
        run.agents(float("nan"))


@pytest.mark.parametrize("fps", [0, -1, float("nan"), float("inf"), 1e300])
def test_frame_rates_that_are_none_are_refused(corridor, fps):
    with pytest.raises(sc.Error, match="fps"):
        sc.run(corridor, fps=fps)


def test_validation_is_a_table():
    table = sc.validate("single-file", profile="walk+sph", progress=False)
    assert {"case", "profile", "quantity", "value", "least", "most", "passed"} <= set(table)
    assert len(table) > 0
    with pytest.raises(sc.Error, match="no such case"):
        sc.validate("nowhere")


def test_the_program_starts_without_pandas():
    code = "import sys, sandbox_crowds; print('pandas' in sys.modules, 'numpy' in sys.modules)"
    said = subprocess.check_output([sys.executable, "-c", code], text=True)
    assert said.split() == ["False", "False"]


def test_exit_codes_are_those_of_the_program():
    def code(*words):
        words = [sys.executable, "-m", "sandbox_crowds", *words]
        return subprocess.run(words, capture_output=True).returncode

    assert code("list") == 0
    assert code("run", "no/such.json") == 2
    assert code("--nonsense") == 2
    assert code("--version") == 0


def test_an_estimate_has_the_errors_asked_for(tmp_path):
    small = {"grids.0.columns": 7, "grids.0.rows": 7}
    answer = sc.estimate("evacuation", {"time_secs": "4%"}, out=tmp_path, **small)
    row = answer.table.loc["time_secs"]
    assert row["reached"] and row["error"] <= 0.04 * row["value"]
    assert row["error"] == pytest.approx(numpy.hypot(row["seeds"], row["step"]))
    values = [at["values"] for at in answer.answer["results"][0]["steps"]]
    assert row["n"] == sum(map(len, values)) == len(list((tmp_path / "cases").glob("*.json")))
    run = sc.run("evacuation", preset="fast", seed=2, **small)
    own = answer.answer["results"][0]["steps"]
    steps = {at["step"]: at["values"] for at in own}
    assert run.measurements["metrics"].get("time_secs", run.measurements["time_secs"]) == steps[0.025][1]
    assert answer.plot().png.startswith(b"\x89PNG")
    with pytest.warns(UserWarning, match="at most 4 runs were allowed"):
        few = sc.estimate("evacuation", {"time_secs": 0.001}, most_runs=4, **small)
    assert few.table["n"].tolist() == [4] and not few.table["reached"].any()
    with pytest.raises(sc.Error, match="no such result"):
        sc.estimate("evacuation", {"flow": "2%"}, **small)


def test_a_bound_is_the_largest_of_the_runs_that_it_needs(tmp_path):
    small = {"grids.0.columns": 4, "grids.0.rows": 4}
    answer = sc.estimate("evacuation", bound={"time_secs": "80%"}, out=tmp_path, **small)
    row = answer.bounds.loc["time_secs"]
    values = answer.answer["bounds"][0]["values"]
    # 1 - 0.8^14 = 0.956
    assert row["n"] == len(values) == 14 and row["bound"] == max(values)
    assert row["confidence"] == pytest.approx(1 - 0.8**14) and row["share"] == 0.8
    assert answer.table.empty and "time_secs" in repr(answer)
    assert answer.plot().png.startswith(b"\x89PNG")
    with pytest.raises(sc.Error, match="nothing is asked for"):
        sc.estimate("evacuation", **small)
