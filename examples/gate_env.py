"""Gymnasium: a gate as action, the density before an exit as observation, and forks to try both actions."""

import gymnasium
import numpy as np

import sandbox_crowds as sc

LOW, HIGH = np.array([8.0, 2.0]), np.array([12.0, 6.0])  # the place that must not get too dense, m
HALL = {
    "name": "gate",
    "profile": "steer+sph",
    "walkable_area": [[[[0, 0], [12, 0], [12, 8], [0, 8]]], [[[12, 3.5], [16, 3.5], [16, 4.5], [12, 4.5]]]],
    "exits": [{"name": "exit", "line": [[16, 3.5], [16, 4.5]]}],
    "entrances": [{"name": "gate", "line": [[0, 1], [0, 7]], "per_sec": 2.5, "arrivals": "poisson", "until_secs": 60}],
}


class GateEnv(gymnasium.Env):
    """Every second, 0 closes the gate and 1 opens it. Rewards: a point for each person who leaves, less the density
    above the limit."""

    observation_space = gymnasium.spaces.Box(0.0, np.inf, shape=(2,), dtype=np.float64)
    action_space = gymnasium.spaces.Discrete(2)

    def __init__(self, simulation=None, secs=90, limit=2.5):
        self.first = self.simulation = simulation or sc.Simulation(HALL)
        self.secs, self.limit = secs, limit

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.simulation = self.first.fork()
        self.simulation.events()  # begins to watch
        return self.observe(), {}

    def step(self, action):
        (self.simulation.open if action else self.simulation.close)("gate")
        self.simulation.step(round(1 / self.simulation.time_step))
        seen, left = self.observe(), len(self.simulation.events().left)
        reward = left - max(0.0, seen[0] - self.limit)
        return seen, reward, False, self.simulation.time >= self.secs, {"left": left}

    def observe(self):
        """The density before the exit, P/m², and the number of people inside."""
        places = self.simulation.positions
        before = np.all((places >= LOW) & (places <= HIGH), axis=1).sum()
        return np.array([before / np.prod(HIGH - LOW), len(places)])

    def look_ahead(self, secs=15):
        """The action that is better for the next seconds, tried on forks."""
        copies = {action: GateEnv(self.simulation.fork(), self.secs, self.limit) for action in (1, 0)}
        return max(copies, key=lambda action: sum(copies[action].step(action)[1] for _ in range(secs)))


if __name__ == "__main__":
    for name, choose in [("open", lambda environment: 1), ("look ahead", GateEnv.look_ahead)]:
        environment, total, densest, over = GateEnv(), 0.0, 0.0, False
        environment.reset()
        while not over:
            seen, reward, _, over, _ = environment.step(choose(environment))
            total, densest = total + reward, max(densest, seen[0])
        print(f"{name}: {total:.1f} points, at most {densest:.2f} P/m²")
