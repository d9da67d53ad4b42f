"""Models of JuPedSim, on an open floor."""

import jupedsim as jps

MARGIN = 10.0


def begin(crowd, setting):
    xs = [x for agent in crowd for x in (agent[0], agent[3])]
    ys = [y for agent in crowd for y in (agent[1], agent[4])]
    left, right = min(xs) - MARGIN, max(xs) + MARGIN
    low, high = min(ys) - MARGIN, max(ys) + MARGIN
    simulation = jps.Simulation(
        model=getattr(jps, setting.model)(),
        geometry=[(left, low), (right, low), (right, high), (left, high)],
        dt=setting.time_step,
    )
    stage = simulation.add_direct_steering_stage()
    journey = simulation.add_journey(jps.JourneyDescription([stage]))
    parameters = getattr(jps, setting.model + "AgentParameters")
    agents = []
    for x, y, radius, goal_x, goal_y in crowd:
        agent = simulation.add_agent(
            parameters(
                position=(x, y),
                journey_id=journey,
                stage_id=stage,
                desired_speed=setting.preferred_speed,
                radius=radius,
            )
        )
        simulation.agent(agent).target = (goal_x, goal_y)
        agents.append(agent)
    return simulation.iterate, lambda: [simulation.agent(agent).position for agent in agents]
