"""Read the results of a Densify run (layout: doc/results.md).  Needs numpy and h5py.

    from densify_results import Results
    results = Results("results/hot_press")
    results.history["relative_density"]          # array, a value an output time
    results.snapshot(-1).particles["radius"]     # array, a value a particle
"""

import pathlib

import h5py
import numpy as np


class Snapshot:
    """One moment: plain arrays by name in `particles`, `contacts`, `walls` and `cell` (empty when not in use)."""

    def __init__(self, group):
        self.time = float(group.attrs["time"])  # [s]
        self.temperature = float(group.attrs["temperature"])  # [K]
        self.pressure = float(group.attrs["pressure"])  # [Pa]
        self.relative_density = float(group.attrs["relative_density"])
        self.stage = str(group.attrs["stage"])
        self.materials = _array(group["materials"]).tolist()
        self.particles = _arrays(group, "particles")
        self.contacts = _arrays(group, "contacts")
        self.walls = _arrays(group, "walls")
        self.cell = _arrays(group, "cell")

    def branches(self):
        """Vectors from the first to the second particle of every contact, across periodic faces too [m]."""
        place = np.empty(int(self.particles["id"].max()) + 1, dtype=int)
        place[self.particles["id"]] = np.arange(len(self.particles["id"]))
        x = self.particles["position"]
        branch = x[place[self.contacts["second_id"]]] - x[place[self.contacts["first_id"]]]
        if "image" in self.contacts:
            code = self.contacts["image"].astype(int)
            image = np.column_stack([code // 9 - 1, code // 3 % 3 - 1, code % 3 - 1])
            branch = branch + image @ self.cell["edges"]
        return branch


class Results:
    """The results folder of a run, finished or still going on."""

    def __init__(self, folder):
        self.path = pathlib.Path(folder) / "result.h5"
        with h5py.File(self.path, "r") as file:
            self.effective_input = file["effective_input"].asstr()[()]
            self.version = str(file.attrs["densify_version"])
            self.git_revision = str(file.attrs["git_revision"])
            self.complete = bool(file.attrs["complete"])
            self.history = _arrays(file, "history")
            self.units = {name: str(data.attrs["unit"]) for name, data in file["history"].items() if "unit" in data.attrs}
            self._names = sorted(file["snapshots"], key=int)
            self.times = np.array([file["snapshots"][name].attrs["time"] for name in self._names])  # [s]

    def __len__(self):
        return len(self._names)

    def snapshot(self, number):
        """Snapshot by number; negative numbers count from the last."""
        with h5py.File(self.path, "r") as file:
            return Snapshot(file["snapshots"][self._names[number]])


def _array(data):
    return data.asstr()[()] if h5py.check_string_dtype(data.dtype) else data[()]


def _arrays(parent, name):
    return {key: _array(data) for key, data in parent[name].items()} if name in parent else {}
