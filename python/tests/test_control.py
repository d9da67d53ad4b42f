"""Control from outside: what is done acts from the next frame on, is recorded, and fails as a whole."""

import json
import subprocess
import sys

import numpy
import pytest

import sandbox_crowds as sc

HALL = {
    "name": "hall",
    "duration_secs": 60,
    "walkable_area": [[[[0, 0], [20, 0], [20, 10], [0, 10]]]],
    "exits": [
        {"name": "east", "line": [[20, 4], [20, 6]]},
        {"name": "west", "line": [[0, 4], [0, 6]]},
    ],
    "waiting_areas": [{"name": "square", "area": [[9, 2], [12, 2], [12, 8], [9, 8]], "for_secs": 50}],
    "zones": [{"name": "mud", "area": [[13, 0], [16, 0], [16, 10], [13, 10]]}],
    "journeys": [
        {"name": "through", "stages": ["east"]},
        {"name": "wait", "stages": ["square", "east"]},
    ],
    "grids": [
        {"name": "people", "min": [1, 2], "max": [5, 8], "columns": 4, "rows": 4, "journey": "through"},
        {"name": "others", "min": [6, 9], "max": [8, 9.9], "columns": 2, "rows": 1, "journey": "wait"},
    ],
    "entrances": [
        {
            "name": "top",
            "line": [[16, 10], [19, 10]],
            "per_sec": 1,
            "number": 40,
            "journey": "through",
            "preferred_speed": 1.0,
        }
    ],
}


@pytest.fixture
def hall():
    return sc.Simulation(json.loads(json.dumps(HALL)))


def test_added_people_enter_where_there_is_room(hall):
    hall.step(20)
    before = hall.agents().set_index("id")
    place = before.loc[0, ["pos_x", "pos_y"]].to_numpy(float)
    added = hall.add([[10, 9], place, [10, 9.1], [12, 9]], "people")
    assert added.without_room.tolist() == [1, 2]
    assert added.ids.tolist() == [len(before), len(before) + 1]
    assert len(hall) == len(before)  # not yet
    hall.step()
    after = hall.agents().set_index("id")
    assert set(added.ids) <= set(after.index)
    numpy.testing.assert_allclose(after.loc[added.ids, ["pos_x", "pos_y"]], [[10, 9], [12, 9]], atol=0.05)
    hall.step(2500)
    assert not set(added.ids) & set(hall.ids.tolist())  # they left through the exit of their journey


def test_a_group_must_be_named_if_there_are_several(hall, corridor):
    with pytest.raises(sc.Error, match="there are people, others, top"):
        hall.add([[10, 9]])
    with pytest.raises(sc.Error, match=r"did you mean `people`"):
        hall.add([[10, 9]], "peple")
    alone = sc.Simulation(corridor)
    assert len(alone.add([[10, 1]]).ids) == 1


def test_removed_people_are_gone_and_have_not_arrived(hall):
    hall.step(5)
    hall.remove([3, 5])
    assert {3, 5} <= set(hall.ids.tolist())
    hall.step()
    assert not {3, 5} & set(hall.ids.tolist())
    with pytest.raises(sc.Error, match="agent 3: not present at .* it has left"):
        hall.set_speed(3, 1.0)
    hall.step(2500)
    report = hall.measurements
    assert report["removed"] == 2
    assert report["agents"] == report["arrived"] + report["remaining"] + 2


def test_speeds_journeys_and_zones_change_how_people_walk(hall):
    hall.set_speed([0, 1], [0.0, 0.7])
    hall.set_zone("mud", 0.3)
    hall.step(40)
    speeds = numpy.linalg.norm(hall.velocities, axis=1)
    by_id = dict(zip(hall.ids.tolist(), speeds))
    assert by_id[0] < 0.15 and 0.4 < by_id[1] < 0.95
    hall.set_journey(list(range(2, 16)), "wait")
    hall.step(500)
    in_square = (hall.positions[:, 0] > 8.5) & (hall.positions[:, 0] < 12.5)
    assert set(range(2, 16)) <= set(hall.ids[in_square].tolist())
    hall.release("square")
    hall.step(200)
    rows = hall.agents()
    in_mud = rows[(rows.pos_x > 13.5) & (rows.pos_x < 15.5)]
    assert len(in_mud) > 5 and in_mud.speed.median() < 0.6 and in_mud.speed.max() < 0.9


def test_closed_exits_and_entrances_let_nobody_pass(hall):
    hall.close("east")
    hall.close("top")
    hall.step(1500)
    assert hall.measurements["arrived"] == 0 and len(hall) == 19
    hall.open("east")
    hall.set_capacity("east", 0.5)
    hall.step(50 * 20)  # 20 s
    assert 8 <= hall.measurements["arrived"] <= 11
    hall.set_rate("top", 0)
    hall.open("top")
    hall.step(50)
    waiting = len(hall)
    hall.step(50)
    assert waiting > 10


def test_a_push_moves_those_in_its_region(hall):
    hall.set_speed(hall.ids, 0)
    hall.step(150)
    hall.push([[0, 0], [6, 10]], 0.5, acceleration=[[0, 2], [0.5, 2]], direction=[0, 1])
    hall.step(25)
    rows = hall.agents()
    pushed = rows[(rows.id < 16)]
    assert pushed.vel_y.max() > 0.2 and abs(rows[rows.id.isin([16, 17])].vel_y).max() < 0.2


@pytest.mark.parametrize(
    "what, message",
    [
        (lambda s: s.add([[30, 5]], "people"), r"\(30, 5\) lies in an obstacle or outside"),
        (lambda s: s.add([[5, 5, 1]], "people"), r"positions: points of shape \(people, 2\)"),
        (lambda s: s.add([[float("nan"), 1]], "people"), "finite"),
        (lambda s: s.remove(77), "agent 77: not present .* only 19 agents have entered"),
        (lambda s: s.set_goal(0, [-1, 9]), "outside of the walkable area"),
        (lambda s: s.set_journey(0, "thru"), "no journey is named `thru`"),
        (lambda s: s.set_speed([0, 1], [1, 2, 3]), r"speed: a number, or one for each of 2 agents"),
        (lambda s: s.set_speed(0, -1), r"set_speed.preferred_speeds\[0\]: must be at least 0 and at most 100, not -1"),
        (lambda s: s.set_speed([0, 0], 1), r"set_speed.agents\[1\]: agent 0 is given twice"),
        (lambda s: s.set_goal([3, 3], [5, 5]), "agent 3 is given twice"),
        (lambda s: s.open("nort"), "no exit, door, entrance or waiting area is named `nort`"),
        (lambda s: s.open("square"), "`square` is a waiting area"),
        (lambda s: s.release("east"), "`east` is a exit|`east` is an exit"),
        (lambda s: s.set_capacity("square", 1), "no exit is named `square`; there are east, west"),
        (lambda s: s.set_capacity("east", 0), "set_capacity.most_per_sec: must be above 0"),
        (lambda s: s.set_rate("top", -1), "set_rate.per_sec: must be at least 0"),
        (lambda s: s.set_zone("mud", 0), "set_zone.speed_factor: must be at least 0.01 and at most 10, not 0"),
        (lambda s: s.push([[5, 5], [1, 1]], 1), "the lower left corner comes first"),
        (lambda s: s.push([[1, 1], [5, 5]], -1), "push.for_secs: must be at least 0"),
        (lambda s: s.push([[1, 1], [5, 5]], 1e9), "push.for_secs: must be at least 0 and at most 1e7"),
    ],
)
def test_what_is_not_possible_is_an_error_and_changes_nothing(hall, what, message):
    alone = sc.Simulation(HALL)
    hall.step(10)
    alone.step(10)
    with pytest.raises(sc.Error, match=message):
        what(hall)
    for one in (hall, alone):
        one.step(50)
    assert hall.state_sha256 == alone.state_sha256
    assert "interventions" not in hall.scenario()


def test_no_ids_do_nothing(hall):
    for act in (hall.remove, lambda ids: hall.set_speed(ids, 1), lambda ids: hall.set_goal(ids, [1, 1])):
        act([])
    hall.set_journey([], "wait")
    assert hall.add(numpy.empty((0, 2)), "people").ids.size == 0
    assert "interventions" not in hall.scenario()


def played(simulation):
    """Some of everything."""
    simulation.step(7)
    simulation.add([[10, 9], [10.6, 9]], "people", velocities=[0.5, 0])
    simulation.close("east")
    simulation.step(100)
    simulation.set_goal([0, 1], [[2, 2], [3, 9]])
    simulation.remove(4)
    simulation.set_speed([2, 3], 0.5)
    simulation.step(33)
    simulation.open("east")
    simulation.set_journey([5, 6], "wait")
    simulation.set_rate("top", 3)
    simulation.push([[0, 0], [9, 9]], 1, goal_scale=3)
    simulation.step(200)
    simulation.set_zone("mud", 0.5)
    simulation.set_capacity("east", 1)
    simulation.step(100)


def test_the_scenario_of_what_was_done_ends_in_the_same_state(hall, tmp_path):
    played(hall)
    document = hall.scenario()
    kinds = [next(key for key in one if key != "frame") for one in document["interventions"]]
    assert kinds == [
        "add", "close", "set_goal", "remove", "set_speed", "open", "set_journey", "set_rate", "push", "set_zone",
        "set_capacity",
    ]  # fmt: skip
    assert [one["frame"] for one in document["interventions"]][:3] == [8, 8, 108]
    again = sc.Simulation(document)
    again.step(hall.frame)
    assert again.state_sha256 == hall.state_sha256
    file = tmp_path / "played.json"
    file.write_text(json.dumps(document))
    command = [sys.executable, "-m", "sandbox_crowds", "run", str(file), "--json", "--threads", "1"]
    report = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
    assert report["state_sha256"] == hall.state_sha256


def test_forks_saved_states_and_rewound_ones_know_what_was_done(hall):
    hall.keep(every=1.0)
    played(hall)
    restored, fork = sc.Simulation.restore(hall.save()), hall.fork()
    assert restored.scenario() == fork.scenario() == hall.scenario()
    hall.rewind(6)
    done = hall.scenario()["interventions"]
    assert [next(iter(set(one) - {"frame"})) for one in done][:2] == ["add", "close"]
    assert len(done) < len(fork.scenario()["interventions"])
    for one in (restored, fork):
        one.step(50)
    assert restored.state_sha256 == fork.state_sha256
