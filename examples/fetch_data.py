#!/usr/bin/env python3
"""Fetches the trajectories of experiments that `sandbox validate --data` reads, and checks their SHA-256.

    python3 examples/fetch_data.py --list       # sources and terms; fetches nothing
    python3 examples/fetch_data.py data
    sandbox validate --data data --profile steer+sph

It needs Python 3.8 or later, and nothing else. The files are not part of this repository. They come from public
repositories on GitHub, each at a fixed commit, over HTTPS; a file with another SHA-256 is refused. The heads of the two
pushes are a pickled table of pandas: it is read without running code from it, and written as text.

Read the terms first. The license of a repository says nothing about trajectories that it took from elsewhere.

    --from FOLDER   takes the files from clones that lie side by side in this folder (PedPy, OpenTraj, LEMONS)
"""

import argparse
import array
import hashlib
import io
import pickle
import sys
import urllib.request
from pathlib import Path

ADDRESS = "https://raw.githubusercontent.com"
# Seconds without an answer after which a download is given up.
LIMIT = 60

# Repositories: commit, and license as its own file states it.
REPOSITORIES = {
    "PedestrianDynamics/PedPy": ("8179b4b39e7c1e09eeb6b7d0f4e41f66e98cd6e4", "MIT"),
    "crowdbotp/OpenTraj": ("97ec1d5e1b579f26febeaa9083705952deac338a", "MIT"),
    "Crowd-Mechanics/LEMONS": ("0117dd7d9456dc92a8629f1e5458d68f7974ffa7", "CeCILL-B"),
}
UNCONFIRMED = "as the archive states them; other projects name CC BY 4.0, which we have not confirmed"
ARCHIVE = "Pedestrian Dynamics Data Archive, Forschungszentrum Jülich"
HERMES = f"{ARCHIVE}, https://ped.fz-juelich.de/da (Hermes project, 2009)"
# Where trajectories are from, and their terms.
ORIGINS = {
    "bottleneck": (f"{ARCHIVE}, https://doi.org/10.34735/ped.2018.1 (University of Wuppertal, 2018)", UNCONFIRMED),
    "corridor": (HERMES, UNCONFIRMED),
    "corner": (
        "reference tests of PedPy, which do not say where the trajectories are from",
        "not stated; the repository has the license MIT",
    ),
    "push": (
        "S. Feldmann and J. Adrian (2023), https://doi.org/10.1016/j.ssci.2023.106173, in LEMONS",
        'CeCILL-B ("every part of LEMONS")',
    ),
}

UNI = "notebooks/demo-data/uni-directional"
BI = "datasets/HERMES/Corridor-2D"
PUSH = "data/tutorial_mechanical_layer/push_Feldmann"
TUESDAY = f"{PUSH}/Tue_15_m_noW_row2_15_w_s_b_p_n_d"
WEDNESDAY = f"{PUSH}/Wed_03_m_wiW_row4_14_w_s_b_p_n_u"
HEADS = "measured_head_trajectories.pkl"
FORCE = "external_force_per_mass.txt"
# The second push begins with two seconds in which nothing happens: seconds that are left out, and frames per second.
STARTS = {"push_tue_15": 0, "push_wed_03": 2}
FRAME_RATE = 25


def same(contents, _start):
    """The file as it is."""
    return contents


class Inert:
    """Stands for every class of a pickled table: it keeps what it is made of, and does nothing."""

    def __init__(self, *made_of):
        self.made_of = made_of
        self.state = None

    def __setstate__(self, state):
        self.state = state


class Table(pickle.Unpickler):
    """Reads a pickled table of pandas without pandas: only the names below are known, and none of them runs code."""

    KNOWN = {
        ("pandas.core.frame", "DataFrame"),
        ("pandas.core.internals.managers", "BlockManager"),
        ("pandas._libs.internals", "_unpickle_block"),
        ("pandas.core.indexes.base", "Index"),
        ("pandas.core.indexes.base", "_new_Index"),
        ("pandas.core.indexes.range", "RangeIndex"),
        ("numpy.core.multiarray", "_reconstruct"),
        ("numpy._core.multiarray", "_reconstruct"),
        ("numpy", "ndarray"),
        ("numpy", "dtype"),
        ("builtins", "slice"),
    }

    def find_class(self, module, name):
        if (module, name) not in self.KNOWN:
            raise ValueError(f"a table of numbers has no {module}.{name}")
        return slice if name == "slice" else Inert

    def columns(self):
        """The columns of numbers by name."""
        manager = self.load().state["_mgr"]
        blocks, (names, _rows) = manager.made_of
        # An index is made of its class and of the array with its data.
        names = values(names.made_of[1]["data"])[0]
        columns = {}
        for block in blocks:
            data, places, _dimension = block.made_of
            places = range(len(names))[places] if isinstance(places, slice) else values(places)[0]
            columns.update((names[place], column) for place, column in zip(places, values(data)))
        return columns


def values(of):
    """The rows of an array of one or two dimensions."""
    _version, shape, kind, by_columns, data = of.state
    code = kind.made_of[0]
    if code in ("i8", "f8"):
        flat = array.array({"i8": "q", "f8": "d"}[code], data)
        if sys.byteorder == "big":
            flat.byteswap()
    else:
        flat = data
    count, length = ([1, *shape])[-2:]
    if by_columns and count > 1:
        return [list(flat[row::count]) for row in range(count)]
    return [list(flat[row * length : (row + 1) * length]) for row in range(count)]


def heads(contents, start):
    """The heads from `start` seconds on, as a table with commas."""
    columns = Table(io.BytesIO(contents)).columns()
    rows = zip(*(columns[name] for name in ["id", "frame", "x", "y"]))
    kept = [row for row in rows if row[1] >= FRAME_RATE * start]
    lines = ["id,frame,x,y", *(",".join(map(repr, row)) for row in kept)]
    return ("\n".join(lines) + "\n").encode()


def force(contents, start):
    """The measured force over mass from `start` seconds on; times begin at 0."""
    head, *lines = contents.decode().splitlines()
    rows = [[float(number) for number in line.split(" ")] for line in lines]
    rows = [(time - start, force) for time, force in rows if time - start >= 0]
    lines = [head, *(f"{time!r} {force!r}" for time, force in rows)]
    return ("\n".join(lines) + "\n").encode()


PEDPY, OPENTRAJ, LEMONS = REPOSITORIES
# Files: origin, repository, path in it, conversion, SHA-256 before the conversion.
FILES = {
    "040_c_56_h-.txt": ("bottleneck", PEDPY, "notebooks/demo-data/bottleneck/040_c_56_h-.txt", same,
        "aa36fd35f4af8f729441488415d7e558035fded26b3f060b051cbc20a85b4a67"),
    "uo-180-180-180.txt": ("corridor", PEDPY, f"{UNI}/uo-180-180-180.txt", same,
        "8036c017394046303bf2ef6ff5b91c71f484c6438e14311bccf437a364045746"),
    "uo-180-180-120.txt": ("corridor", PEDPY, f"{UNI}/uo-180-180-120.txt", same,
        "8c2dc7c275246abd67576ead1c98edb0a01eb12b8074f7042cd5d3ab88c4089b"),
    "uo-180-180-095.txt": ("corridor", PEDPY, f"{UNI}/uo-180-180-095.txt", same,
        "6ef980de738e925c140918beb435f8fcd9e0bd0dd1e68ead25808c1529f13869"),
    "bo-360-090-090.txt": ("corridor", OPENTRAJ, f"{BI}/bo-360-090-090.txt", same,
        "41f960a0f7b4178c133bc7af9c709be9b3412072d797e6d7850e49d1ed55d485"),
    "bo-360-160-160.txt": ("corridor", OPENTRAJ, f"{BI}/bo-360-160-160.txt", same,
        "6df7e394a7adad362c9371d2ec48c90ba8acbaaac43d11eb642a737115fc0f22"),
    "corner.txt": ("corner", PEDPY, "tests/reference_tests/data/corner/traj.txt", same,
        "fd665aaf8e2a4afdc00409dbc0ebb0f7d0908505bb7f6c67a0cc2d25cb68ac8d"),
    "push_tue_15.csv": ("push", LEMONS, f"{TUESDAY}/{HEADS}", heads,
        "72e32e10acb3437ca4c8b4605ff4c0efcdb38ad99781b49339714ce757819449"),
    "push_tue_15.txt": ("push", LEMONS, f"{TUESDAY}/{FORCE}", force,
        "896c76ca5a57d6b6585e7203bc1a87cd70cc65711ad3edf7e63f833032e22d88"),
    "push_wed_03.csv": ("push", LEMONS, f"{WEDNESDAY}/{HEADS}", heads,
        "daec4373ec61a4a1f416aa4bde9694931e5565594838c711306b5276816378f9"),
    "push_wed_03.txt": ("push", LEMONS, f"{WEDNESDAY}/{FORCE}", force,
        "3cd46d20745248abf1f2f205fecf05335c2656ad1b691b3c48de8ae86e893f02"),
}


def terms():
    """Sources and terms of all files, as text."""
    lines = []
    for name, (origin, repository, path, convert, _digest) in FILES.items():
        commit, own = REPOSITORIES[repository]
        of, said = ORIGINS[origin]
        converted = "" if convert is same else ", converted"
        lines += [
            name,
            f"  from        https://github.com/{repository}/blob/{commit}/{path}{converted}",
            f"  measured by {of}",
            f"  terms       {said}",
            f"  license of the repository that has it: {own}",
        ]
    return "\n".join(lines)


def read(repository, path, clones):
    """A file of a repository, from a clone or from GitHub."""
    if clones is not None:
        return (clones / repository.split("/")[1] / path).read_bytes()
    commit, _ = REPOSITORIES[repository]
    with urllib.request.urlopen(f"{ADDRESS}/{repository}/{commit}/{path}", timeout=LIMIT) as answer:
        return answer.read()


def is_there(name, folder):
    """Whether the folder has the file, as the repository has it. Converted files are small, and fetched again."""
    _origin, _repository, _path, convert, expected = FILES[name]
    file = folder / name
    return convert is same and file.is_file() and hashlib.sha256(file.read_bytes()).hexdigest() == expected


def fetch(name, folder, clones):
    """Writes one file into the folder; says what became of it."""
    _origin, repository, path, convert, expected = FILES[name]
    contents = read(repository, path, clones)
    found = hashlib.sha256(contents).hexdigest()
    if found != expected:
        raise ValueError(f"its SHA-256 is {found}, not {expected}: {repository}/{path} is not the file that is meant")
    written = convert(contents, STARTS.get(Path(name).stem, 0))
    unfinished = folder / f"{name}.part"
    unfinished.write_bytes(written)
    unfinished.replace(folder / name)
    return f"{len(written):,} bytes, SHA-256 of the source {expected}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, help="where the files are put, for --data")
    parser.add_argument("--from", dest="clones", type=Path, metavar="FOLDER", help="clones in place of GitHub")
    parser.add_argument("--list", action="store_true", help="print sources and terms, and fetch nothing")
    options = parser.parse_args()
    if options.folder is None and not options.list:
        parser.error("name the folder for the files, such as data; or give --list")
    print(terms(), flush=True)
    if options.list:
        return 0
    options.folder.mkdir(parents=True, exist_ok=True)
    failed = 0
    print()
    for name in FILES:
        if is_there(name, options.folder):
            print(f"{name}: is there already, with the right SHA-256")
            continue
        try:
            print(f"{name}: {fetch(name, options.folder, options.clones)}", flush=True)
        except (OSError, ValueError, pickle.UnpicklingError) as error:
            failed += 1
            print(f"error: {name}: {error}", file=sys.stderr)
    if failed:
        print(f"error: {failed} of {len(FILES)} files are missing; try again, or use --from", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
