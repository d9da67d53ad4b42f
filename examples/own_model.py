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


def length(vectors):
    """Of vectors, faster than np.linalg.norm."""
    return np.hypot(vectors[:, 0], vectors[:, 1])


def inverse(numbers):
    """One over numbers, 0 for 0."""
    return np.divide(1.0, numbers, out=np.zeros_like(numbers), where=numbers > 0)


def social_force(frame):
    """Accelerations of all people, m/s²: toward the preferred velocity (Eq. 17), and away from others (Eq. 18)."""
    goal = (frame.preferred_velocities - frame.velocities) / RELAXATION
    i, j, r = frame.first, frame.second, frame.separations
    v = frame.velocities[i]
    way = AHEAD * (v - frame.velocities[j])
    later = r + way
    near, far, speed = length(r), length(later), length(v)
    total = near + far
    b = 0.5 * np.sqrt(np.maximum(total**2 - (way[:, 0] ** 2 + way[:, 1] ** 2), 1e-300))
    slope = STRENGTH / RANGE * np.exp(-b / RANGE) * total / (4 * b)
    ahead = -(v[:, 0] * r[:, 0] + v[:, 1] * r[:, 1]) >= SEEN * speed * near  # all around for those who stand
    slope *= np.where(ahead, 1.0, UNSEEN)
    push = r * (slope * inverse(near))[:, None] + later * (slope * inverse(far))[:, None]
    return (goal + frame.sum_over_pairs(push)) / frame.masses[:, None]


MODEL = sc.Model(social_force, reach=RADIUS, stiffness=STRENGTH / RANGE**2 / 0.8)

if __name__ == "__main__":
    # The profile's walls and contacts act on; its own social force between people is switched off.
    run = sc.run(CORRIDOR, model=MODEL, profile="sf", parameters={"agent_strength": 0, "goal_scale": 0})
    run.draw(at=60, out="lanes.png", trails=1.5, color="speed")
    print(run)
