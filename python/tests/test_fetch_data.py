"""examples/fetch_data.py: which files it fetches, what it refuses, and its reading of pickled tables."""

import importlib.util
import json
import os
import pickle
from pathlib import Path

import pandas
import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def script():
    spec = importlib.util.spec_from_file_location("fetch_data", ROOT / "examples/fetch_data.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_it_fetches_the_files_of_the_validation_and_names_the_terms_of_each(script):
    suite = json.loads((ROOT / "scenarios/studies/validation.json").read_text())
    assert set(script.FILES) == {data["file"] for data in suite["data"]}
    terms = script.terms()
    for name, (_, repository, path, _, digest) in script.FILES.items():
        _, own = terms.split(f"{name}\n", 1)
        lines = own.splitlines()[:4]
        commit, license = script.REPOSITORIES[repository]
        assert f"github.com/{repository}/blob/{commit}/{path}" in lines[0]
        assert lines[2].startswith("  terms ") and lines[3].endswith(license)
        assert len(commit) == 40 and len(digest) == 64


def test_a_pickled_table_is_read_as_pandas_reads_it(script, monkeypatch):
    table = pandas.DataFrame(
        {
            "id": [0, 0, 1, 1],
            "who": pandas.Series(["a", "b", "a", "b"], dtype=object),
            "x": [0.1, -1e-7, 0.83, 3.0],
            "frame": [49, 50, 51, 52],
            "y": [1 / 3, 2.0, 3.5, 1e22],
        }
    )
    table.columns = pandas.Index(list(table.columns), dtype=object)
    # Where this version of pandas has the same classes.
    others = {("pandas", name) for name in ("DataFrame", "Index", "RangeIndex")}
    monkeypatch.setattr(script.Table, "KNOWN", script.Table.KNOWN | others)
    for start, first in [(0, 0), (2, 1)]:
        expected = table.iloc[first:][["id", "frame", "x", "y"]].to_csv(index=False)
        assert script.heads(pickle.dumps(table, protocol=4), start).decode() == expected


def test_a_pickle_that_runs_code_is_refused(script, tmp_path):
    class Trap:
        def __reduce__(self):
            return os.mkdir, (str(tmp_path / "trapped"),)

    with pytest.raises(ValueError, match="a table of numbers has no"):
        script.heads(pickle.dumps(Trap()), 0)
    assert not (tmp_path / "trapped").exists()


def test_forces_begin_at_the_start(script):
    assert script.force(b"TimeS Force\n1.5 1.0\n2.0 3.25\n2.5 4.0\n", 2) == b"TimeS Force\n0.0 3.25\n0.5 4.0\n"


def test_a_file_with_another_checksum_is_refused_and_not_written(script, tmp_path, monkeypatch, capsys):
    for _, repository, path, _, _ in script.FILES.values():
        file = tmp_path / "clones" / repository.split("/")[1] / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("other people\n")
    folder = tmp_path / "data"
    monkeypatch.setattr("sys.argv", ["fetch_data.py", str(folder), "--from", str(tmp_path / "clones")])
    assert script.main() == 1
    assert list(folder.iterdir()) == []
    said = capsys.readouterr().err
    assert said.count("its SHA-256 is") == len(script.FILES) and f"{len(script.FILES)} of" in said
