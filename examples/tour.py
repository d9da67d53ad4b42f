"""An evacuation in PedPy: positions, N(t) at the door, speed over density.

    pip install pedpy
    sandbox evacuation --trajectory evacuation.sqlite
    python examples/tour.py evacuation.sqlite evacuation.png

The cells (# %%) can be run one by one in Jupyter, VS Code, Spyder or PyCharm.
"""

# %% The trajectories and the walkable area.
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import pedpy

names = [name for name in sys.argv[1:] if Path(name).suffix in {".sqlite", ".png"}]
file, picture = (names + ["evacuation.sqlite", "evacuation.png"][len(names) :])[:2]
crowd = pedpy.load_trajectory_from_jupedsim_sqlite(trajectory_file=Path(file))
area = pedpy.load_walkable_area_from_jupedsim_sqlite(trajectory_file=Path(file))
print(f"{crowd.data.id.nunique()} people, {crowd.data.frame.max() / crowd.frame_rate:.0f} s")

# %% Flow: crossings of the outer end of the door.
door = pedpy.MeasurementLine([(21, 9.6), (21, 10.4)])
nt, crossings = pedpy.compute_n_t(traj_data=crowd, measurement_line=door)
times = crossings["frame"].sort_values().to_numpy() / crowd.frame_rate
print(f"flow through the door: {(len(times) - 1) / (times[-1] - times[0]):.2f} people per second")

# %% Density and speed of everyone, once per second for the first two minutes.
seconds = crowd.data[(crowd.data.frame % 10 == 0) & (crowd.data.frame <= 1200)]
moments = pedpy.TrajectoryData(seconds[["id", "frame", "x", "y"]], frame_rate=crowd.frame_rate)
cut_off = pedpy.Cutoff(radius=1.0, quad_segments=8)
cells = pedpy.compute_individual_voronoi_polygons(traj_data=moments, walkable_area=area, cut_off=cut_off)
speeds = pedpy.compute_individual_speed(
    traj_data=crowd, frame_step=5, speed_calculation=pedpy.SpeedCalculation.BORDER_SINGLE_SIDED
)
both = cells.merge(speeds, on=["id", "frame"])

# %% The picture.
figure, (left, middle, right) = plt.subplots(1, 3, figsize=(15, 4.5), layout="constrained")
moment = 15 * int(crowd.frame_rate)
pedpy.plot_voronoi_cells(
    voronoi_data=cells[cells.frame == moment],
    traj_data=moments,
    frame=moment,
    walkable_area=area,
    axes=left,
    color_by_column="density",
    cb_label="density [1/m²]",
    vmin=0,
    vmax=8,
    agent_size=3,
)
left.set(title="after 15 s", xlim=(-1, 24), ylim=(-1, 21))
middle.plot(nt.time, nt.cumulative_pedestrians)
middle.set(title="through the door", xlabel="time [s]", ylabel="people")
right.hexbin(both.density, both.speed, gridsize=40, mincnt=1, bins="log", extent=(0, 8, 0, 2))
right.set(title="fundamental diagram", xlabel="density [1/m²]", ylabel="speed [m/s]")
figure.savefig(picture, dpi=100)
print(f"{picture} is written")
