"""The listings of docs/guide/python.md run, each by itself."""

import re
from pathlib import Path

import pytest

DOCUMENT = Path(__file__).parents[2] / "docs" / "guide" / "python.md"
LISTINGS = re.findall(
    r"^```python\n(.*?)^```$", DOCUMENT.read_text(encoding="utf-8"), re.M | re.S
)


def test_the_document_has_listings():
    assert len(LISTINGS) >= 3


@pytest.mark.parametrize("listing", LISTINGS)
def test_a_listing_runs_by_itself(listing, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    exec(compile(listing, DOCUMENT, "exec"), {})
