"""Compares the results of `sandbox measure` with those of PedPy for the same file.

    pip install pedpy
    sandbox evacuation --trajectory run.sqlite
    sandbox measure run.sqlite --line 21,9.6,21,10.4 --out measured
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
