"""The RVO2 library. The model is the largest number of neighbors, or "all"."""

import math

import pyrvo

# The library has no default and its examples have other units than meters.
TIME_HORIZON = 2.0


def begin(crowd, setting):
    neighbors = len(crowd) if setting.model == "all" else int(setting.model)
    simulation = pyrvo.RVOSimulator()
    simulation.set_time_step(setting.time_step)
    for x, y, radius, goal_x, goal_y in crowd:
        agent = simulation.add_agent(
            (x, y),
            setting.radius,
            neighbors,
            TIME_HORIZON,
            TIME_HORIZON,
            radius,
            setting.max_speed,
        )
        # The goals are so far away that the directions hold for the whole measurement.
        pace = setting.preferred_speed / math.dist((x, y), (goal_x, goal_y))
        simulation.set_agent_pref_velocity(agent, ((goal_x - x) * pace, (goal_y - y) * pace))

    def walk(steps):
        for _ in range(steps):
            simulation.do_step()

    def places():
        return [simulation.get_agent_position(k).to_tuple() for k in range(len(crowd))]

    return walk, places
