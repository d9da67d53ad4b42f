"""The listings of the guides for Python run, each by itself."""

import re
from pathlib import Path

import pytest

GUIDE = Path(__file__).parents[2] / "docs" / "guide"
LISTINGS = [
    pytest.param(listing, id=f"{name}-{k}")
    for name in ("python", "own-model")
    for k, listing in enumerate(
        re.findall(r"^```python\n(.*?)^```$", (GUIDE / f"{name}.md").read_text(encoding="utf-8"), re.M | re.S)
    )
]


def test_the_document_has_listings():
    assert len(LISTINGS) >= 6


@pytest.mark.parametrize("listing", LISTINGS)
def test_a_listing_runs_by_itself(listing, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    exec(compile(listing, "listing", "exec"), {})
