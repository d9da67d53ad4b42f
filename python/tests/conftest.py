import pytest

CORRIDOR = {
    "name": "corridor",
    "duration_secs": 4,
    "walkable_area": [[[[0, 0], [12, 0], [12, 10], [10, 10], [10, 2], [0, 2]]]],
    "exits": [{"name": "end", "line": [[10, 10], [12, 10]]}],
    "grids": [{"min": [1, 0.5], "max": [4, 1.5], "columns": 4, "rows": 2}],
    "measurements": [{"egress": {}}],
}


@pytest.fixture
def corridor():
    """Eight people walk round a corner to an exit."""
    import copy

    return copy.deepcopy(CORRIDOR)
