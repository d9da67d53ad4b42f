"""A forecast: counts at doors go into a twin of a hall, whose forks say how dense it will be before a narrow gap.

    python forecast.py --until 180

Every 10 s the twin takes in how many people came through each door, as a camera would count them, and 20 forks of it run
60 s ahead. The "reality" is a second simulation of the hall, with another seed and with a train that the twin knows
nothing of. SI units.
"""

import argparse
import os
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import sandbox_crowds as sc

PERIOD = 10  # s, from one count to the next
FEARED = np.array([[20.5, 6], [23.5, 10]])  # m, the place before the gap: lower left and upper right corner
SPEED = {"mean": 1.34, "std": 0.26, "min": 0.5, "max": 2.2}  # preferred speeds, m/s
BAND = [0.05, 0.95]
FROM_TRAIN, STREET, TRAIN_AT = [0.5, 4.0], 0.8, [60, 100]  # P/s without and with a train; P/s; s


def rectangle(x0, y0, x1, y1, shift):
    """The corners of a rectangle, moved by `shift`."""
    return (np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]) + shift).tolist()


def hall(seed, arrivals, halls=1):
    """The scenario: two entrances in the west, a gap of 2.4 m, two exits in the east; or several such halls."""
    floor = {"walkable_area": [], "entrances": [], "exits": [], "journeys": []}
    for k in range(halls):
        shift = np.array([60 * (k // 10), 26 * (k % 10)])
        line = lambda *ends: (np.array(ends) + shift).tolist()
        parts = [(0, 0, 24, 16), (23.9, 6.8, 24.6, 9.2), (24.5, 0, 40, 16)]
        floor["walkable_area"] += [[rectangle(*part, shift)] for part in parts]
        floor["exits"] += [
            {"name": f"north {k}", "line": line([40, 10], [40, 14])},
            {"name": f"south {k}", "line": line([40, 2], [40, 6])},
        ]
        floor["journeys"] += [{"name": f"out {k}", "stages": [{"shares": {f"north {k}": 3, f"south {k}": 2}}]}]
        traits = {"per_sec": 1, "arrivals": arrivals, "journey": f"out {k}", "preferred_speed": {"normal": SPEED}}
        floor["entrances"] += [
            {"name": f"train {k}", "line": line([0, 1], [0, 6]), **traits},
            {"name": f"street {k}", "line": line([0, 10], [0, 15]), **traits},
        ]
    return {"name": "hall", "profile": "steer+sph", "seed": seed, "duration_secs": 3600, **floor}


def advance(simulation, secs):
    """Steps to the frame that is `secs` seconds later."""
    simulation.step(round(secs / simulation.time_step))


def density(simulation, place=FEARED):
    """People per square meter in a rectangle."""
    low, high = place
    inside = ((simulation.positions >= low) & (simulation.positions <= high)).all(axis=1)
    return inside.sum() / np.prod(high - low)


def counted(entered, entrances):
    """How many people entered by each entrance: by the one whose middle is nearest to their first position."""
    middles = np.array([np.mean(one["line"], axis=0) for one in entrances])
    places = np.column_stack([entered["x"], entered["y"]])
    nearest = np.linalg.norm(places[:, None] - middles, axis=2).argmin(axis=1)
    return dict(zip([one["name"] for one in entrances], np.bincount(nearest, minlength=len(middles)).tolist()))


def drawn_future(counts, horizon, rng):
    """People who may come in each period ahead: Poisson numbers at a rate from the gamma posterior of the count."""
    periods = -(-horizon // PERIOD)
    return {name: rng.poisson(rng.gamma(count + 0.5), periods) for name, count in counts.items()}


def look_ahead(fork, future, speeds, horizon, place=FEARED):
    """The density at a place in each of the next `horizon` seconds, if people come in as in `future`."""
    fork.set_speed(fork.ids, speeds)
    densities = []
    for second in range(horizon):
        if second % PERIOD == 0:
            for name, numbers in future.items():
                fork.set_rate(name, numbers[second // PERIOD] / PERIOD)
        advance(fork, 1)
        densities.append(density(fork, place))
    return densities


def forecast(twin, counts, horizon=60, forks=20, seed=0, place=FEARED, workers=None):
    """Densities at a place, P/m², of shape (forks, horizon): one row per fork of the twin, one column per second."""
    rng = np.random.default_rng([seed, twin.frame])
    jobs = []
    for _ in range(forks):
        speeds = np.clip(rng.normal(SPEED["mean"], SPEED["std"], len(twin)), SPEED["min"], SPEED["max"])
        jobs.append((twin.fork(), drawn_future(counts, horizon, rng), speeds))
    with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
        return np.array(list(pool.map(lambda job: look_ahead(*job, horizon, place), jobs)))


def take_in(twin, counts):
    """The last period again, now with the people who were counted in it."""
    for name, count in counts.items():
        twin.set_rate(name, count / PERIOD)
    advance(twin, PERIOD)


def observe(reality):
    """One period of the reality: the counts at its doors, and the density in each second."""
    now = reality.time
    for one in ENTRANCES(reality):
        with_train = TRAIN_AT[0] <= now < TRAIN_AT[1]
        reality.set_rate(one["name"], FROM_TRAIN[with_train] if "train" in one["name"] else STREET)
