"""A forecast: counts at doors drive a twin of a hall, and forks of the twin show how dense it may get before a gap.

    python forecast.py                 # 180 s; every 10 s a forecast of the next 60 s
    python forecast.py --train 0       # the same without a train

Every 10 s the twin takes in the number of people who came through each door, as a camera would count them. Then its
forks run ahead, with arrivals drawn from what the counts say about the rates. The "reality" is another simulation of
the same hall with another seed, in which a train arrives. The twin knows only the counts. All units are SI units.
"""

import argparse
import os
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import sandbox_crowds as sc

PERIOD = 10  # s, from one count to the next
PLACE = np.array([[21, 6], [24, 10]])  # m, the area before the gap: lower left and upper right corner
SPEED = {"mean": 1.34, "std": 0.26, "min": 0.5, "max": 2.2}  # preferred speeds, m/s
BAND = [0.05, 0.95]  # quantiles
RATES = {"platform": 0.5, "street": 0.8}  # P/s, in the reality
TRAIN = [60, 100]  # s, when more people come from the platform


def hall(seed, arrivals, halls=1):
    """The scenario of one or more halls: two entrances in the west, a gap of 2 m, two exits in the east."""
    areas, exits, entrances, journeys = [], [], [], []
    for k in range(halls):
        shift = np.array([60 * (k // 10), 26 * (k % 10)])
        for x0, y0, x1, y1 in [(0, 0, 24, 16), (23.9, 7, 24.6, 9), (24.5, 0, 40, 16)]:
            areas.append([(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]) + shift).tolist()])
        for name, *y in [("north", 10, 14), ("south", 2, 6)]:
            exits.append({"name": f"{name} {k}", "line": [[40 + shift[0], end + shift[1]] for end in y]})
        journeys.append({"name": f"out {k}", "stages": [{"shares": {f"north {k}": 3, f"south {k}": 2}}]})
        for name, *y in [("platform", 1, 6), ("street", 10, 15)]:
            line = [[shift[0], end + shift[1]] for end in y]
            flow = {"arrivals": arrivals, "per_sec": RATES[name], "from_secs": 1, "preferred_speed": {"normal": SPEED}}
            entrances.append({"name": f"{name} {k}", "line": line, "journey": f"out {k}"} | flow)
    floor = {"walkable_area": areas, "exits": exits, "entrances": entrances, "journeys": journeys}
    model = {"profile": "steer+sph", "preset": "fast", "route_choice": "shortest"}
    return {"name": "hall", "seed": seed, "duration_secs": 3600} | model | floor


def hall_with_train(seed, per_sec, halls=1):
    """The scenario of the reality: people arrive at random, and those of a train by the line of the platform."""
    scenario = hall(seed, "poisson", halls)
    for entrance in scenario["entrances"][::2] if per_sec > 0 else []:
        train = {"name": "train at " + entrance["name"], "from_secs": TRAIN[0], "until_secs": TRAIN[1]}
        scenario["entrances"].append(entrance | train | {"per_sec": per_sec})
    return scenario


def advance(simulation, secs):
    """Steps to the frame that is `secs` later."""
    simulation.step(round(secs / simulation.time_step))


def density(simulation, place=PLACE):
    """The number of people in a rectangle over its area, P/m²."""
    low, high = place
    inside = (simulation.positions >= low) & (simulation.positions <= high)
    return inside.all(axis=1).sum() / np.prod(high - low)


def counts_of(entered, doors):
    """How many people entered at each door: each at the one whose middle is nearest to the first position."""
    middles = np.array([np.mean(door["line"], axis=0) for door in doors])
    first = np.column_stack([entered["x"], entered["y"]])
    nearest = np.linalg.norm(first[:, None] - middles, axis=2).argmin(axis=1)
    return {door["name"]: int((nearest == k).sum()) for k, door in enumerate(doors)}


def observe(reality, doors):
    """Simulates one period of the reality. Returns the counts at its doors and the density after each second."""
    densities = []
    for _ in range(PERIOD):
        advance(reality, 1)
        densities.append(density(reality))
    return counts_of(reality.events().entered, doors), densities


def take_in(twin, counts):
    """Simulates the period of the counts in the twin, in which as many people enter as were counted."""
    for name, count in counts.items():
        twin.set_rate(name, count / PERIOD)
    advance(twin, PERIOD)


def draw(counts, people, horizon, rng):
    """What a fork does not know: arrivals per period ahead at each entrance, and the preferred speeds of those inside.

    An entrance's rate comes from the gamma posterior of its count. Poisson numbers at this rate are its arrivals.
    """
    periods = -(-horizon // PERIOD)
    arrivals = {name: rng.poisson(rng.gamma(count + 0.5), periods) for name, count in counts.items()}
    return arrivals, np.clip(rng.normal(SPEED["mean"], SPEED["std"], people), SPEED["min"], SPEED["max"])


def look_ahead(fork, arrivals, speeds, horizon, place):
    """The density at a place after each second, up to the horizon."""
    fork.set_speed(fork.ids, speeds)
    densities = []
    for second in range(horizon):
        if second % PERIOD == 0:
            for name, numbers in arrivals.items():
                fork.set_rate(name, numbers[second // PERIOD] / PERIOD)
        advance(fork, 1)
        densities.append(density(fork, place))
    return densities


def forecast(twin, counts, horizon=60, forks=20, seed=0, place=PLACE, workers=None):
    """Densities at a place, P/m², of shape (forks, horizon): a row per fork of the twin, a column per second."""
    rng = np.random.default_rng([seed, twin.frame])
    draws = [draw(counts, len(twin.ids), horizon, rng) for _ in range(forks)]
    jobs = [(twin.fork(), arrivals, speeds, horizon, place) for arrivals, speeds in draws]
    with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
        return np.array(list(pool.map(lambda job: look_ahead(*job), jobs)))


def band(densities):
    """The lower and the upper end of the band in each second."""
    return np.quantile(densities, BAND, axis=0)


def print_hits(bands, truth, horizon):
    """Prints how many values of the reality, one per second, lie inside of the bands of earlier forecasts."""
    print(f"\nvalues of the reality inside of the bands ({BAND[0]:.0%} to {BAND[1]:.0%} of the forks):")
    for begin in range(0, horizon, PERIOD):
        ahead = range(begin + 1, min(begin + PERIOD, horizon) + 1)
        pairs = [(bands[now][:, secs - 1], truth[now + secs]) for now in bands for secs in ahead if now + secs in truth]
        hits = sum(low <= value <= high for (low, high), value in pairs)
        print(f"{ahead[0]:3d} to {ahead[-1]:2d} s ahead: {hits} of {len(pairs)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--horizon", type=int, default=60, help="how far ahead the forks run, s")
    parser.add_argument("--forks", type=int, default=20)
    parser.add_argument("--until", type=int, default=180, help="the end of the reality, s")
    parser.add_argument("--people", type=int, default=1, metavar="N", help="N halls with N times the people")
    parser.add_argument("--train", type=float, default=5.0, help="people per second from the train")
    parser.add_argument("--seed", type=int, default=1, help="of the reality and of the draws")
    args = parser.parse_args()

    known = hall(1, "constant", args.people)
    twin = sc.Simulation(known)
    reality = sc.Simulation(hall_with_train(1000 + args.seed, args.train, args.people))
    reality.events()  # begins to watch
    bands, truth = {}, {}
    print(f"             counts       density, P/m²    band in {args.horizon} s,  people    of real")
    print("time   platform  street    twin  reality      P/m²       in twin     time")
    for now in range(PERIOD, args.until + 1, PERIOD):
        counts, seen = observe(reality, known["entrances"])
        truth |= {now - PERIOD + k: value for k, value in enumerate(seen, 1)}
        begun = time.perf_counter()
        take_in(twin, counts)
        bands[now] = band(forecast(twin, counts, args.horizon, args.forks, args.seed))
        share, (low, high) = (time.perf_counter() - begun) / PERIOD, bands[now][:, -1]
        platform, street = counts["platform 0"], counts["street 0"]
        print(f"{now:3d} s {platform:9d} {street:7d} {density(twin):7.2f} {truth[now]:8.2f}", end="   ")
        print(f"{low:6.2f} – {high:.2f} {len(twin.ids):9d} {share:10.0%}")
    print_hits(bands, truth, args.horizon)


if __name__ == "__main__":
    main()
