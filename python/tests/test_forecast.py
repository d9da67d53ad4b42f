"""examples/forecast.py: the band is that of its forks, the twin stays as it is, and the counts are those of doors."""

import importlib.util
import re
from pathlib import Path

import numpy
import pytest
import shapely

import sandbox_crowds as sc

ROOT = Path(__file__).parents[2]
COUNTS = {"platform 0": 45, "street 0": 9}
HORIZON = 12
BEFORE_GAP, BEHIND_DOOR = [[21, 6], [24, 10]], [[0, 0], [6, 8]]


@pytest.fixture
def script():
    spec = importlib.util.spec_from_file_location("forecast", ROOT / "examples/forecast.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def twin(script):
    """A twin with a crowd before the gap."""
    twin = sc.Simulation(script.hall(1, "constant"))
    for _ in range(4):
        script.take_in(twin, COUNTS)
    return twin


def stepped_by_hand(script, twin, forks, seed, place):
    """The densities of the forecast by other code: one fork after the other, people counted by shapely."""
    rng = numpy.random.default_rng([seed, twin.frame])
    area = shapely.box(*place[0], *place[1])
    rows = []
    for _ in range(forks):
        arrivals, speeds = script.draw(COUNTS, len(twin.ids), HORIZON, rng)
        fork, row = twin.fork(), []
        fork.set_speed(fork.ids, speeds)
        for second in range(HORIZON):
            for name in COUNTS if second in (0, 10) else ():
                fork.set_rate(name, int(arrivals[name][second // 10]) / 10)
            end = fork.time + 1
            while fork.time < end - 1e-6:
                fork.step()
            row.append(sum(area.covers(shapely.Point(point)) for point in fork.positions) / area.area)
        rows.append(row)
    return numpy.array(rows)


@pytest.mark.parametrize("place", [BEFORE_GAP, BEHIND_DOOR])
def test_the_band_is_that_of_forks_stepped_by_hand(script, twin, place):
    forks = 6
    by_hand = stepped_by_hand(script, twin, forks, 3, place)
    ahead = script.forecast(twin, COUNTS, HORIZON, forks, 3, numpy.array(place))
    numpy.testing.assert_allclose(ahead, by_hand, rtol=0, atol=1e-12)
    assert by_hand.max() > 0.3 and numpy.ptp(by_hand, axis=0).max() > 0  # there is a crowd, and the forks differ
    low, high = script.band(ahead)
    assert low.shape == high.shape == (HORIZON,)
    assert (low <= high).all()
    assert (by_hand.min(axis=0) <= low).all() and (high <= by_hand.max(axis=0)).all()
    # With six forks, at most one is below 5 % and one above 95 %.
    assert ((by_hand < low).sum(axis=0) <= 1).all() and ((by_hand > high).sum(axis=0) <= 1).all()


def test_the_same_forecast_twice_is_the_same_and_leaves_the_twin_as_it_is(script, twin):
    before, alone = twin.state_sha256, twin.fork()
    first = script.forecast(twin, COUNTS, HORIZON, forks=3, seed=5, workers=1)
    again = script.forecast(twin, COUNTS, HORIZON, forks=3, seed=5, workers=3)
    other = script.forecast(twin, COUNTS, HORIZON, forks=3, seed=6)
    numpy.testing.assert_array_equal(script.band(first), script.band(again))
    assert (first != other).any()
    assert twin.state_sha256 == before
    for one in (twin, alone):
        script.take_in(one, COUNTS)
    assert twin.state_sha256 == alone.state_sha256


def entries_by_door(simulation, frames):
    """How many people entered in the south and in the north half of the hall, by their ids in every frame."""
    known = set(simulation.ids.tolist())
    south = north = 0
    for _ in range(frames):
        simulation.step()
        for id, (_, y) in zip(simulation.ids.tolist(), simulation.positions):
            if id not in known:
                known.add(id)
                south, north = (south + 1, north) if y < 8 else (south, north + 1)
    return {"platform 0": south, "street 0": north}


def test_the_counts_are_those_who_entered_the_reality(script, monkeypatch):
    monkeypatch.setattr(script, "TRAIN", [10, 20])
    doors = script.hall(7, "poisson")["entrances"]
    reality = sc.Simulation(script.hall_with_train(7, 5.0))
    reality.events()
    copy = reality.fork()
    for _ in range(3):
        counts, densities = script.observe(reality, doors)
        assert entries_by_door(copy, round(script.PERIOD / copy.time_step)) == counts
        assert len(densities) == script.PERIOD and densities[-1] == script.density(copy)
        assert reality.events().entered.size == 0
        assert 20 < sum(counts.values()) if 10 < reality.time < 21 else sum(counts.values()) < 30
    assert copy.state_sha256 == reality.state_sha256


def test_arrivals_of_the_reality_go_on_at_their_rates(script):
    reality = sc.Simulation(script.hall_with_train(2, 0))
    reality.events()
    script.advance(reality, 300)
    entered = reality.events().entered
    assert len(entered) == pytest.approx(1.3 * 299, abs=4 * (1.3 * 299) ** 0.5)
    assert (entered["y"] < 8).sum() == pytest.approx(0.5 * 299, abs=4 * (0.5 * 299) ** 0.5)
    assert numpy.diff(entered["time"]).max() < 12


@pytest.mark.parametrize("counts", [COUNTS, {"platform 0": 0, "street 0": 1}, {"platform 0": 3, "street 0": 0}])
def test_as_many_people_enter_the_twin_as_were_counted(script, counts):
    twin, copy = (sc.Simulation(script.hall(1, "constant")) for _ in range(2))
    for _ in range(3):
        script.take_in(twin, counts)
        for name, count in counts.items():
            copy.set_rate(name, count / 10)
        assert entries_by_door(copy, round(10 / copy.time_step)) == counts
    assert copy.state_sha256 == twin.state_sha256


def test_drawn_arrivals_vary_as_rates_and_people_do(script):
    """Poisson numbers at a rate of the gamma distribution: mean n + ½, variance 2 (n + ½)."""
    rng = numpy.random.default_rng(1)
    drawn = [script.draw({"door": 20}, 5, 25, rng) for _ in range(4000)]
    arrivals = numpy.array([numbers["door"] for numbers, _ in drawn])
    assert arrivals.shape == (4000, 3)
    assert arrivals[:, 0].mean() == pytest.approx(20.5, abs=0.5)
    assert arrivals[:, 0].var() == pytest.approx(41, rel=0.12)
    speeds = numpy.array([speeds for _, speeds in drawn])
    assert speeds.shape == (4000, 5)
    assert speeds.mean() == pytest.approx(1.34, abs=0.02) and 0.5 <= speeds.min() <= speeds.max() <= 2.2


def test_halls_are_counted_apart(script):
    scenario = script.hall(1, "constant", halls=12)
    simulation = sc.Simulation(scenario)
    simulation.events()
    counts = {entrance["name"]: k % 4 for k, entrance in enumerate(scenario["entrances"])}
    script.take_in(simulation, counts)
    assert script.counts_of(simulation.events().entered, scenario["entrances"]) == counts


@pytest.mark.parametrize("densities, hits", [([0.0, 99.0], True), ([98.0, 99.0], False)])
def test_what_it_prints(script, monkeypatch, capsys, densities, hits):
    """A line per period with the counts of the reality, and how many of its values are in bands with all or none."""

    def forecast(twin, counts, horizon, forks, seed):
        return numpy.tile(numpy.array(densities)[:, None], horizon)

    monkeypatch.setattr(script, "BAND", [0, 1])
    monkeypatch.setattr(script, "TRAIN", [10, 20])
    monkeypatch.setattr(script, "forecast", forecast)
    monkeypatch.setattr("sys.argv", "forecast.py --until 30 --horizon 15 --seed 4".split())
    script.main()
    text = capsys.readouterr().out
    doors = script.hall(1004, "poisson")["entrances"]
    reality = sc.Simulation(script.hall_with_train(1004, 5.0))
    reality.events()
    expected = [list(script.observe(reality, doors)[0].values()) for _ in range(3)]
    printed = [line.split() for line in text.splitlines() if re.match(r" *\d+ s ", line)]
    assert [int(line[0]) for line in printed] == [10, 20, 30]
    assert [[int(line[2]), int(line[3])] for line in printed] == expected
    # Forecasts at 10, 20 and 30 s of a reality that ends at 30 s.
    found = re.findall(r"(\d+) to +(\d+) s ahead: (\d+) of (\d+)", text)
    assert [[int(number) for number in one] for one in found] == [[1, 10, 20 * hits, 20], [11, 15, 5 * hits, 5]]
