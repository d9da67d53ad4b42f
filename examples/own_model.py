"""A model of one's own: the social force of van Toll et al. (2021), §5.3.1, in NumPy, on two streams that form lanes.

    python own_model.py            # writes lanes.png
"""

import numpy as np

import sandbox_crowds as sc

STRENGTH, RANGE, AHEAD, RADIUS = 2.1, 0.3, 2.0, 5.0  # V₀ m²/s², σ m, T s, avoidance radius m
RELAXATION = 0.5  # τ s
SEEN, UNSEEN = np.cos(np.radians(100)), 0.5  # half the field of view, and the weight of those outside

CORRIDOR = {
    "name": "lanes",
    "duration_secs": 60,
    "walkable_area": [[[[0, 0], [40, 0], [40, 5], [0, 5]]]],
    "periodic": {"axis": "x", "length": 40},
    "crowds": [
        {"name": "right", "area": [[0, 0.3], [40, 0.3], [40, 4.7], [0, 4.7]], "number": 60, "goal": {"direction": [1, 0]}},
        {"name": "left", "area": [[0, 0.3], [40, 0.3], [40, 4.7], [0, 4.7]], "number": 60, "goal": {"direction": [-1, 0]}},
    ],
}


def unit(vectors):
    """Vectors of length 1; zero stays zero."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


def social_force(frame):
    """Accelerations of all people, m/s²: toward the preferred velocity (Eq. 17), and away from others (Eq. 18)."""
    goal = (frame.preferred_velocities - frame.velocities) / RELAXATION
    i, j, r = frame.first, frame.second, frame.separations
    way = AHEAD * (frame.velocities[i] - frame.velocities[j])
    total = np.linalg.norm(r, axis=1) + np.linalg.norm(r + way, axis=1)
    b = 0.5 * np.sqrt(np.maximum(total**2 - (way**2).sum(axis=1), 1e-300))
    slope = STRENGTH / RANGE * np.exp(-b / RANGE) * total / (4 * b)
    ahead = (unit(frame.velocities)[i] * unit(-r)).sum(axis=1) >= SEEN
    stands = (frame.velocities[i] == 0).all(axis=1)
    weight = np.where(ahead | stands, 1.0, UNSEEN)
    push = (unit(r) + unit(r + way)) * (slope * weight)[:, None]
    return (goal + frame.sum_over_pairs(push)) / frame.masses[:, None]


MODEL = sc.Model(social_force, reach=RADIUS, stiffness=STRENGTH / RANGE**2 / 0.8)

if __name__ == "__main__":
    # The profile's walls and contacts act on; its own social force between people is switched off.
    run = sc.run(CORRIDOR, model=MODEL, profile="sf", parameters={"agent_strength": 0, "goal_scale": 0})
    run.draw(at=60, out="lanes.png", trails=1.5, color="speed")
    print(run)
