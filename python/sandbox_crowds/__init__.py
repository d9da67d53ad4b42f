"""Dense crowds: simulation, measurement and inspection of people at up to ten per square meter.

    import sandbox_crowds as sc
    run = sc.run("evacuation", until=20)
    run.agents(at=15)          # a DataFrame, one row per agent
    run.draw(at=15)            # a picture

Step by step, for loops that observe and steer:

    simulation = sc.Simulation("evacuation", seed=2)
    simulation.step(100)
    simulation.positions       # an array of shape (agents, 2), meters

SI units. Mass is dimensionless, 1 = an average person, so that densities are in persons per square meter (P/m²).
A scenario is a dict as in a scenario file, the path of such a file, or the name of a scenario that comes with the
program: see `scenarios()`. Settings are the keys of a scenario file, as keywords: `seed=2`, `profile="sf->sph"`,
`viscosity=5`, `**{"sources.0.rows": 50}`.
"""

from ._control import Added
from ._estimate import Estimate, estimate
from ._model import Frame, Model
from ._native import Error, __version__, scenarios
from ._run import Run, columns, run
from ._simulation import Events, Simulation
from ._study import sweep, validate

__all__ = [
    "Added",
    "Error",
    "Estimate",
    "Events",
    "Frame",
    "Model",
    "Run",
    "Simulation",
    "__version__",
    "columns",
    "estimate",
    "run",
    "scenarios",
    "sweep",
    "validate",
]
