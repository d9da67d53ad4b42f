"""Compares what PedPy measures in a trajectory with the sandbox's own results.

    pip install pedpy
    sandbox evacuation --trajectory run.sqlite --trajectory run.txt --trajectory run.csv --json > run.json
    python examples/pedpy_check.py run.sqlite run.txt run.csv run.json
"""

import json
import sqlite3
import sys
from pathlib import Path

import pandas as pd
import pedpy

database, text, csv, report = map(Path, sys.argv[1:])
metrics = json.loads(report.read_text())["metrics"]
failures = []


def compare(what, pedpys, ours, within):
    agrees = abs(pedpys - ours) <= within * abs(ours)
    print(f"{what:<44} {pedpys:8.4f} {ours:8.4f}  {pedpys / ours - 1:+.2%} (at most {within:.2g}){'' if agrees else '  !'}")
    if not agrees:
        failures.append(what)


print(f"{'':<44} {'PedPy':>8} {'sandbox':>8}")

# %% All files agree, and everyone is in the walkable area.
crowd = pedpy.load_trajectory_from_jupedsim_sqlite(trajectory_file=database)
area = pedpy.load_walkable_area_from_jupedsim_sqlite(trajectory_file=database)
columns = ["id", "frame", "x", "y"]
rows = pd.read_csv(csv).rename(columns={"pos_x": "x", "pos_y": "y"})
from_text = pedpy.load_trajectory_from_txt(trajectory_file=text)
from_csv = pedpy.TrajectoryData(rows[columns], frame_rate=1 / rows.time[rows.frame == 1].iloc[0])
for same in [from_text, from_csv]:
    assert crowd.frame_rate == same.frame_rate == 10
    difference = crowd.data[columns] - same.data[columns]
    assert difference.abs().to_numpy().max() < 1e-12
assert pedpy.is_trajectory_valid(traj_data=crowd, walkable_area=area)

# %% Flow: people who cross the outer end of the door reach the goal half a meter later.
door = pedpy.MeasurementLine([(21, 9.6), (21, 10.4)])
_, crossings = pedpy.compute_n_t(traj_data=crowd, measurement_line=door)
times = crossings["frame"].sort_values().to_numpy() / crowd.frame_rate
assert abs(len(times) - metrics["evacuated"]) <= 1
compare("flow of the first 350, 1/s", 349 / (times[349] - times[0]), metrics["flow_per_s"], 0.01)

# %% Density at 15 s: the file has the sandbox's own density; Voronoi cells are another estimate of the same quantity.
frame = int(15 * crowd.frame_rate)
of_frame = f"SELECT avg(density) FROM trajectory_data WHERE frame = {frame}"


def mean_density(query):
    with sqlite3.connect(database) as connection:
        return connection.execute(query).fetchone()[0]


ours = metrics["density_mean_15s"]
compare("mean of the column density at 15 s, 1/m²", mean_density(of_frame), ours, 1e-9)
moment = pedpy.TrajectoryData(crowd.data[crowd.data.frame == frame][columns], frame_rate=crowd.frame_rate)
cut_off = pedpy.Cutoff(radius=1.0, quad_segments=8)
cells = pedpy.compute_individual_voronoi_polygons(traj_data=moment, walkable_area=area, cut_off=cut_off)
compare("mean of 1/(Voronoi cell) at 15 s, 1/m²", cells["density"].mean(), ours, 0.1)
square = pedpy.MeasurementArea([(15, 8), (19, 8), (19, 12), (15, 12)])
inside = f"{of_frame} AND pos_x BETWEEN 15 AND 19 AND pos_y BETWEEN 8 AND 12"
voronoi, _ = pedpy.compute_voronoi_density(individual_voronoi_data=cells, measurement_area=square)
classic = pedpy.compute_classic_density(traj_data=moment, measurement_area=square)
for name, found in [("Voronoi", voronoi), ("classic", classic)]:
    compare(f"{name} density before the door at 15 s, 1/m²", found["density"].iloc[0], mean_density(inside), 0.05)

sys.exit(f"these do not agree: {failures}" if failures else 0)
