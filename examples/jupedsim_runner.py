#!/usr/bin/env python3
"""Runs a scene of `sandbox validate --runner` in JuPedSim and writes the trajectories.

    pip install jupedsim==1.4.2 shapely
    sandbox validate --runner "python3 examples/jupedsim_runner.py"
    sandbox validate --runner "python3 examples/jupedsim_runner.py --model anticipation"
    python3 examples/jupedsim_runner.py scene.json trajectory.txt       # one scene

It needs JuPedSim 1.4 and shapely 2. The trajectories are text as PedPy reads it: the frame rate, then one row
`id frame x y` per person and frame, in meters. Frame 0 is time 0; the ids are those of the scene.

The scene gives the floor, the places, and the position, entry time and preferred speed of each person. Everything else
is JuPedSim's default: radii, time gaps, routes, and the time step of 0.01 s.

- Agents enter where they touch no other agent and no wall. People whose place is taken try again every 0.1 s, in the
  order of their ids. People who would touch a wall are moved away from it.
- Agents leave 0.1 m before the line of an exit. If the line lies on the edge of the floor, the floor goes on behind it.
- If a stage has several places, each agent takes the nearest one when its stage begins.

At the end a line on stderr counts the people who never entered, entered late, were moved, or have not left. In dense
crowds the models `social-force` and `gcf` can push agents off the floor. JuPedSim then fails, and so does this script.
"""

import argparse
import json
import math
import sys
from pathlib import Path

try:
    import jupedsim as jps
    import shapely
    from shapely import LineString, Point
except ImportError as error:
    sys.exit(f"{error}; try: pip install jupedsim==1.4.2 shapely")

# Rows per second. Agents also enter, and pass waypoints, at this rate.
FRAME_RATE = 10
# Radius of agents whose model has none: those of the centrifugal force model are ellipses.
RADIUS = 0.2
# Free space between a wall and the body of an agent that enters.
MARGIN = 0.01
# A person farther than this from the floor is an error.
OFF_FLOOR = 0.5
# Agents leave at this distance from the line of an exit.
EXIT_DEPTH = 0.1
# Behind an exit on its edge the floor goes on for this distance.
OPENING = 3.0
# Agents on the way to a waypoint aim at a point this far behind the line, and so cross it at full speed.
AHEAD = 0.5
# If that point is off the floor, they aim at the line, and have passed the waypoint at this distance.
REACHED = 0.05
# Coordinates are rounded to this grid, which unites areas with a common edge.
GRID = 1e-4

# CollisionFreeSpeedModelV2 is missing: with its defaults it is the same model as `cfs`.
MODELS = {
    "cfs": "CollisionFreeSpeedModel",
    "cfs-v3": "CollisionFreeSpeedModelV3",
    "anticipation": "AnticipationVelocityModel",
    "social-force": "SocialForceModel",
    "gcf": "GeneralizedCentrifugalForceModel",
    "warp-driver": "WarpDriverModel",
}


def main():
    parser = argparse.ArgumentParser(description="Runs a scene of `sandbox validate --runner` in JuPedSim.")
    models = [name for name, model in MODELS.items() if hasattr(jps, model)]
    parser.add_argument("--model", choices=models, default="cfs", help="JuPedSim's model (default: cfs)")
    parser.add_argument("scene", type=Path, help="the scene to run, JSON")
    parser.add_argument("trajectory", type=Path, help="the trajectories to write, text")
    arguments = parser.parse_args()
    try:
        scene = json.loads(arguments.scene.read_text(encoding="utf-8"))
        floor = read_floor(arguments.scene.parent / scene["floor"], scene["people"])
        run = Run(scene, floor, arguments.model)
        with arguments.trajectory.open("w", encoding="utf-8") as file:
            run.write_to(file)
    except KeyError as error:
        sys.exit(f"{arguments.scene}: the key {error} is missing")
    except (OSError, ValueError, RuntimeError, shapely.errors.ShapelyError) as error:
        sys.exit(f"{arguments.scene}: {error}")
    print(f"JuPedSim {jps.__version__}, {arguments.model}: {run.summary()}", file=sys.stderr)


def read_floor(path, people):
    """The connected part of the floor on which the people start. JuPedSim simulates one such part."""
    area = shapely.from_wkt(path.read_text(encoding="utf-8"))
    if area.geom_type not in ("Polygon", "MultiPolygon"):
        raise ValueError(f"{path.name} is a {area.geom_type}, not a POLYGON or MULTIPOLYGON")
    parts = shapely.get_parts(shapely.union_all(shapely.get_parts(area), grid_size=GRID))
    first_person = {}
    for person in people:
        distances = shapely.distance(parts, Point(person["position"]))
        if distances.min() > OFF_FLOOR:
            raise ValueError(f"person {person['id']} starts off the floor, at {person['position']}")
        first_person.setdefault(int(distances.argmin()), person["id"])
    if not first_person:
        raise ValueError("the scene has no people")
    if len(first_person) > 1:
        one, other = list(first_person.values())[:2]
        apart = f"people {one} and {other} start on parts of the floor that are not connected"
        raise ValueError(f"{apart}; JuPedSim simulates one part")
    return parts[next(iter(first_person))]


def openings_behind(line, floor):
    """What the floor needs behind an exit on its edge, so that the line is not a wall.

    JuPedSim's agents stay up to 0.5 m away from walls, depending on the model, and would not reach the line. Nothing is
    opened where the opening would touch other floor.
    """
    behind = shapely.get_parts(line.buffer(OPENING, cap_style="flat").difference(floor))
    borders = shapely.intersection(behind, floor)
    return behind[(shapely.length(borders) > 0) & shapely.covers(line.buffer(EXIT_DEPTH), borders)]


class Exit:
    """One straight piece of an exit on the floor: a stage of JuPedSim, at which agents leave."""

    def __init__(self, line, room, simulation):
        self.aim = free_part(line, room)
        self.stage_id = simulation.add_exit_stage(line.buffer(EXIT_DEPTH, cap_style="flat"))
        self.journey_id = simulation.add_journey(jps.JourneyDescription([self.stage_id]))


class Waypoint:
    """A line to cross, to the nearest point of which the script steers each agent.

    It is not a waypoint stage of JuPedSim: that is a disk, and all agents would walk to its center.
    """

    def __init__(self, line, room, steering):
        self.line = line
        self.stage_id, self.journey_id = steering
        self.aim = free_part(line, room)

    def target(self, position, floor):
        x, y = nearest(self.aim, position)
        distance = math.dist((x, y), position)
        if distance > 0:
            ahead = [q + (q - p) * AHEAD / distance for q, p in zip((x, y), position)]
            if shapely.contains_xy(floor, *ahead):
                return tuple(ahead)
        return x, y

    def is_passed(self, before, now, target):
        return self.line.intersects(LineString([before, now])) or math.dist(now, target) < REACHED


def free_part(line, room):
    """The part of a line that the center of an agent can reach without touching a wall, else its middle."""
    return line.intersection(room) if line.intersects(room) else line.interpolate(0.5, normalized=True)


def nearest(geometry, position):
    return shapely.shortest_line(geometry, Point(position)).coords[0]


class Agent:
    """A person in the simulation."""

    def __init__(self, person, stages, position):
        self.person = person
        self.stages = stages
        self.stage = 0
        self.position = position
        self.place = None
        self.target = position


class Run:
    """A scene in JuPedSim: its places, the people who have not entered yet, and the agents."""

    def __init__(self, scene, floor, model):
        exits = {place["name"]: LineString(place["line"]) for place in scene["exits"]}
        waypoints = {place["name"]: LineString(place["line"]) for place in scene.get("waypoints", [])}
        openings = [part for line in exits.values() for part in openings_behind(line, floor)]
        floor = shapely.union_all([floor, *openings], grid_size=GRID)
        # Without vertices within straight walls: agents feel each wall by itself, and there they would feel two.
        self.floor = floor.normalize().simplify(GRID)
        shapely.prepare(self.floor)

        self.parameters = getattr(jps, MODELS[model] + "AgentParameters")
        self.radius = getattr(self.parameters, "radius", RADIUS)
        self.room = self.floor.buffer(-self.radius - MARGIN)
        # Only this model uses random numbers.
        seed = {"rng_seed": scene["seed"]} if model == "anticipation" else {}
        self.simulation = jps.Simulation(model=getattr(jps, MODELS[model])(**seed), geometry=self.floor)
        self.router = jps.RoutingEngine(self.floor)

        stage_id = self.simulation.add_direct_steering_stage()
        steering = stage_id, self.simulation.add_journey(jps.JourneyDescription([stage_id]))
        places = {}
        for name, line in exits.items():
            places[name] = [Exit(part, self.room, self.simulation) for part in self.parts(name, line)]
        for name, line in waypoints.items():
            places[name] = [Waypoint(part, self.room, steering) for part in self.parts(name, line)]
        # People without journey leave by the nearest exit.
        self.journeys = {None: [[place for name in exits for place in places[name]]]}
        for journey in scene.get("journeys", []):
            for name in sum(journey["stages"], []):
                if name not in places:
                    raise ValueError(f"journey {journey['name']}: {name} is neither an exit nor a waypoint")
            stages = [[place for name in stage for place in places[name]] for stage in journey["stages"]]
            self.journeys[journey["name"]] = stages

        self.duration = scene["duration_secs"]
        self.number = len(scene["people"])
        self.waiting = sorted(scene["people"], key=lambda person: person["id"])
        self.agents = {}
        self.late = self.moved = 0

    def parts(self, name, line):
        """The parts of a line that lie on the floor."""
        parts = [part for part in shapely.get_parts(line.intersection(self.floor)) if part.length > 0]
        if not parts:
            raise ValueError(f"the line of {name} lies off the floor")
        return parts

    def write_to(self, file):
        file.write(f"# framerate: {FRAME_RATE}\n# id frame x/m y/m\n")
        for frame in range(math.floor(self.duration * FRAME_RATE) + 1):
            if frame > 0:
                self.advance(frame / FRAME_RATE)
            self.admit(frame / FRAME_RATE)
            for agent in sorted(self.agents.values(), key=lambda agent: agent.person["id"]):
                x, y = agent.position
                file.write(f"{agent.person['id']} {frame} {x:.4f} {y:.4f}\n")
            if not self.waiting and not self.agents:
                break

    def advance(self, time):
        """Simulates the time to the next frame."""
        try:
            self.simulation.iterate(round(1 / (FRAME_RATE * self.simulation.delta_time())))
        except RuntimeError as error:
            raise RuntimeError(f"JuPedSim failed before {time} s: {error}") from error
        positions = {agent.id: agent.position for agent in self.simulation.agents()}
        self.agents = {agent_id: agent for agent_id, agent in self.agents.items() if agent_id in positions}
        for agent_id, agent in self.agents.items():
            before, agent.position = agent.position, positions[agent_id]
            if isinstance(agent.place, Waypoint) and agent.place.is_passed(before, agent.position, agent.target):
                self.begin_next_stage(agent_id)
            self.steer(agent_id)

    def admit(self, time):
        """Lets in the people whose time has come and whose place is free."""
        refused = []
        for person in self.waiting:
            if person["enters_secs"] > time + 1e-9 or not self.enter(person):
                refused.append(person)
            elif time - person["enters_secs"] > 1.5 / FRAME_RATE:
                self.late += 1
        self.waiting = refused

    def enter(self, person):
        journey = person.get("journey")
        if journey not in self.journeys:
            raise ValueError(f"person {person['id']}: there is no journey {journey}")
        position = tuple(person["position"])
        is_moved = not self.room.covers(Point(position))
        if is_moved:
            position = nearest(self.room, position)
        # The social force model accepts agents that overlap, and then throws them off the floor.
        if any(True for _ in self.simulation.agents_in_range(position, 2 * self.radius)):
            return False
        agent = Agent(person, self.journeys[journey], position)
        agent.place = self.nearest_place(agent)
        parameters = self.parameters(
            position=position,
            desired_speed=person["preferred_speed"],
            journey_id=agent.place.journey_id,
            stage_id=agent.place.stage_id,
        )
        try:
            agent_id = self.simulation.add_agent(parameters)
        except RuntimeError as error:
            if "too close to agent" in str(error):
                return False
            raise
        self.agents[agent_id] = agent
        self.moved += is_moved
        self.steer(agent_id)
        return True

    def nearest_place(self, agent):
        """The place of the agent's stage to which the route is shortest."""

        def distance(place):
            route = self.router.compute_waypoints(agent.position, nearest(place.aim, agent.position))
            return sum(map(math.dist, route, route[1:]))

        places = agent.stages[agent.stage]
        return min(places, key=distance) if len(places) > 1 else places[0]

    def begin_next_stage(self, agent_id):
        agent = self.agents[agent_id]
        if agent.stage + 1 < len(agent.stages):
            agent.stage += 1
            agent.place = self.nearest_place(agent)
            self.simulation.switch_agent_journey(agent_id, agent.place.journey_id, agent.place.stage_id)

    def steer(self, agent_id):
        agent = self.agents[agent_id]
        if isinstance(agent.place, Waypoint):
            agent.target = agent.place.target(agent.position, self.floor)
            self.simulation.agent(agent_id).target = agent.target

    def summary(self):
        counts = [
            (self.number, "people"),
            (len(self.waiting), "never entered"),
            (self.late, "entered late"),
            (self.moved, "were moved away from walls"),
            (len(self.agents), f"were inside after {self.duration} s"),
        ]
        return ", ".join(f"{number} {what}" for number, what in counts)


if __name__ == "__main__":
    main()
