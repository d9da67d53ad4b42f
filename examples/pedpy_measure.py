"""Compares the results of `sandbox measure` with those of PedPy for the same file.

    pip install pedpy
    sandbox evacuation --trajectory run.sqlite
    sandbox measure run.sqlite --line 21,9.6,21,10.4 --region 15,8,19,12 --out measured
    python examples/pedpy_measure.py run.sqlite measured
"""

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pedpy

database, folder = map(Path, sys.argv[1:])
crowd = pedpy.load_trajectory_from_jupedsim_sqlite(trajectory_file=database)
agents = pd.read_csv(folder / "agents.csv")
crossings = pd.read_csv(folder / "flow.csv")
assert len(agents) == len(crowd.data)

# %% Speeds: five frames back and five ahead, one-sided where a person enters or leaves.
speeds = pedpy.compute_individual_speed(
    traj_data=crowd, frame_step=5, speed_calculation=pedpy.SpeedCalculation.BORDER_SINGLE_SIDED
)
both = agents.merge(speeds, on=["id", "frame"], suffixes=("", "_pedpy"))
assert len(both) == len(agents)
assert (both.speed.isna() == both.speed_pedpy.isna()).all()
off = (both.speed - both.speed_pedpy).abs().max()
print(f"speeds of {len(both)} rows: off by {off:.2g} m/s at most")
assert off < 1e-9

# %% Flow: PedPy has each person's first crossing; the sandbox marks which crossings count.
door = pedpy.MeasurementLine([(21, 9.6), (21, 10.4)])
n_t, first = pedpy.compute_n_t(traj_data=crowd, measurement_line=door)
passages = crossings[crossings.passage & (crossings.direction == 1)]
assert dict(zip(passages.id, passages.frame)) == dict(zip(first.id, first.frame))
assert passages.forward.max() == n_t["cumulative_pedestrians"].max()
at_frames = np.searchsorted(np.sort(passages.frame), n_t.index, side="right")
assert (at_frames == n_t["cumulative_pedestrians"]).all()
print(f"N(t) of {len(passages)} persons: the same in all {len(n_t)} frames")

# %% Densities in one frame per second: each person's Voronoi cell, then the region before the door.
area = pedpy.load_walkable_area_from_jupedsim_sqlite(trajectory_file=database)
square = pedpy.MeasurementArea([(15, 8), (19, 8), (19, 12), (15, 12)])
seconds = crowd.data[crowd.data.frame % int(crowd.frame_rate) == 0]
sample = pedpy.TrajectoryData(seconds[["id", "frame", "x", "y"]], frame_rate=crowd.frame_rate)
cells = pedpy.compute_individual_voronoi_polygons(
    traj_data=sample, walkable_area=area, cut_off=pedpy.Cutoff(radius=2.0, quad_segments=8)
)
both = agents.merge(cells, on=["id", "frame"])
off = (both.voronoi_density / both.density_y - 1).abs()
print(f"Voronoi densities of {len(both)} rows: off by {off.max():.2g} of the density at most")
assert len(both) == len(seconds) and off.max() < 0.01

regions = pd.read_csv(folder / "fundamental_diagram.csv").query("region == 1").set_index("frame")
voronoi, inside = pedpy.compute_voronoi_density(individual_voronoi_data=cells, measurement_area=square)
speed = pedpy.compute_voronoi_speed(
    traj_data=sample, individual_voronoi_intersection=inside, individual_speed=speeds, measurement_area=square
)
classic = pedpy.compute_classic_density(traj_data=sample, measurement_area=square)
frames = sample.data.frame.unique()
for name, theirs in [
    ("voronoi", voronoi.set_index("frame").density),
    ("voronoi_speed", speed.set_index("frame").speed),
    ("classic", classic.set_index("frame").density),
]:
    ours, theirs = regions[name].loc[frames].fillna(0), theirs.loc[frames]
    off = (ours - theirs).abs().max()
    print(f"{name} of the region in {len(frames)} frames: off by {off:.2g} at most, the mean is {theirs.mean():.4g}")
    assert off < 0.01 * theirs.mean()
