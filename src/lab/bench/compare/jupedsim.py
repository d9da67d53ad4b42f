"""Takes steps of JuPedSim's social force model on request.

Arguments: a file with one agent per line (x, y, radius, x and y of the goal), and the preferred
speed. Prints "ready VERSION TIME_STEP". Then, for each line on stdin with a number of steps, takes
that many steps and prints the seconds that they took.
"""

import sys
import time

import jupedsim as jps

TIME_STEP = 0.01
MARGIN = 10.0

with open(sys.argv[1], encoding="ascii") as people:
    crowd = [tuple(map(float, line.split())) for line in people]
speed = float(sys.argv[2])

xs = [x for person in crowd for x in (person[0], person[3])]
ys = [y for person in crowd for y in (person[1], person[4])]
left, right = min(xs) - MARGIN, max(xs) + MARGIN
low, high = min(ys) - MARGIN, max(ys) + MARGIN
simulation = jps.Simulation(
    model=jps.SocialForceModel(),
    geometry=[(left, low), (right, low), (right, high), (left, high)],
    dt=TIME_STEP,
)
stage = simulation.add_direct_steering_stage()
journey = simulation.add_journey(jps.JourneyDescription([stage]))
for x, y, radius, goal_x, goal_y in crowd:
    person = simulation.add_agent(
        jps.SocialForceModelAgentParameters(
            position=(x, y),
            journey_id=journey,
            stage_id=stage,
            desired_speed=speed,
            radius=radius,
        )
    )
    simulation.agent(person).target = (goal_x, goal_y)

print("ready", jps.__version__, TIME_STEP, flush=True)
for line in sys.stdin:
    start = time.perf_counter()
    simulation.iterate(int(line))
    print(time.perf_counter() - start, flush=True)
