"""The Python reader, the plot and the ParaView files against what sample_results wrote: results_test.py DIR TOOLS."""

import base64
import csv
import pathlib
import subprocess
import sys
import unittest
import xml.etree.ElementTree as xml

SKIPPED = 77
try:
    import h5py  # noqa: F401
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing}; install python3-numpy and python3-h5py to run this test")
    sys.exit(SKIPPED)

FOLDER, TOOLS = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
sys.path.insert(0, str(TOOLS))
from densify_results import Results  # noqa: E402


def read_vtp(path):
    """Arrays of a .vtp file by name, decoded after VTK's description of its XML format."""
    kinds = {"Float64": "<f8", "Float32": "<f4", "UInt8": "u1", "UInt32": "<u4", "Int64": "<i8"}
    arrays = {}
    piece = xml.parse(path).getroot().find("PolyData/Piece")
    for array in piece.iter("DataArray"):
        raw = base64.b64decode(array.text, validate=True)
        assert int.from_bytes(raw[:8], "little") == len(raw) - 8
        values = np.frombuffer(raw[8:], kinds[array.get("type")])
        components = int(array.get("NumberOfComponents"))
        arrays[array.get("Name")] = values.reshape(-1, components) if components > 1 else values
    return {key: int(value) for key, value in piece.attrib.items()}, arrays


class Reader(unittest.TestCase):
    def test_run(self):
        for name, complete in (("periodic", True), ("cylinder", False)):
            results = Results(FOLDER / name)
            self.assertEqual(results.effective_input, 'title = "20 °C"\n')
            self.assertEqual((results.version, results.git_revision), ("0.1.0", "abc123"))
            self.assertEqual(results.complete, complete)
            self.assertEqual(len(results), 3)
            np.testing.assert_array_equal(results.times, results.history["time_s"])
            np.testing.assert_array_equal(results.history["relative_density"], [0.7, 0.7 + 0.1, 0.7 + 0.1 * 2])

    def test_history_equals_csv(self):
        results = Results(FOLDER / "periodic")
        with open(FOLDER / "periodic/history.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        for name, values in results.history.items():
            column = [row[name] if name == "stage" else float(row[name]) for row in rows]
            self.assertEqual(list(values), column)
        self.assertEqual(results.units, {"time_s": "s", "temperature_K": "K", "relative_density": "1"})

    def test_snapshot(self):
        for name in ("periodic", "cylinder"):
            shot = Results(FOLDER / name).snapshot(-1)
            self.assertEqual((shot.stage, shot.materials), ("press", ["soft", "hard"]))
            particles, contacts = shot.particles, shot.contacts
            np.testing.assert_array_equal(particles["id"], np.arange(len(particles["radius"])))
            self.assertEqual(particles["position"].shape, (len(particles["id"]), 3))
            self.assertEqual(particles["stress"].shape, (len(particles["id"]), 6))
            self.assertIn("neck_radius", contacts)
            # Overlap from positions, radii and images, as written: |branch| - r_i - r_j (4.16).
            r = particles["radius"]
            overlap = np.linalg.norm(shot.branches(), axis=1) - r[contacts["first_id"]] - r[contacts["second_id"]]
            np.testing.assert_allclose(overlap, contacts["overlap"], rtol=0, atol=1e-20)
            self.assertEqual(particles["coordination"].sum(), 2 * len(overlap))
        self.assertEqual(list(shot.walls["name"]), ["die", "bottom", "punch"])
        self.assertEqual(shot.cell, {})

    def test_plot(self):
        measured, picture = FOLDER / "measured.csv", FOLDER / "density.png"
        measured.write_text("# by hand\ntime_s,relative_density\n0,0.7\n0.1,0.85\n")
        picture.unlink(missing_ok=True)
        try:
            import matplotlib  # noqa: F401
        except ImportError:
            self.skipTest("matplotlib is missing")
        script = [sys.executable, TOOLS / "plot_density.py", FOLDER / "periodic", FOLDER / "cylinder"]
        subprocess.run(script + ["--measured", measured, "-o", picture], check=True)
        self.assertEqual(picture.read_bytes()[:4], b"\x89PNG")


class ParaView(unittest.TestCase):
    def test_files_hold_the_snapshots(self):
        for name in ("periodic", "cylinder"):
            results = Results(FOLDER / name)
            collection = xml.parse(FOLDER / name / "paraview/particles.pvd").getroot().find("Collection")
            self.assertEqual([float(d.get("timestep")) for d in collection], list(results.times))
            for number, data in enumerate(collection):
                shot = results.snapshot(number)
                sizes, particles = read_vtp(FOLDER / name / "paraview" / data.get("file"))
                self.assertEqual(sizes["NumberOfPoints"], len(shot.particles["id"]))
                np.testing.assert_array_equal(particles["Points"], shot.particles["position"])
                np.testing.assert_array_equal(particles["material"], shot.particles["material"])
                np.testing.assert_array_equal(particles["radius"], shot.particles["radius"].astype("f4"))
                mean = shot.particles["stress"][:, :3].sum(axis=1) / 3
                np.testing.assert_allclose(particles["mean_stress"], mean, rtol=1e-6)
                sizes, contacts = read_vtp(FOLDER / name / f"paraview/contacts_{number:06}.vtp")
                self.assertEqual(sizes["NumberOfLines"], len(shot.contacts["overlap"]))
                lines = contacts["Points"].reshape(-1, 2, 3)
                np.testing.assert_allclose(lines[:, 1] - lines[:, 0], shot.branches(), rtol=0, atol=1e-19)
                np.testing.assert_array_equal(contacts["normal_force"], shot.contacts["normal_force"].astype("f4"))
                self.assertEqual("stress" in particles, results.complete)
                if results.complete:
                    self.stresses(shot, particles, contacts)

    def stresses(self, shot, particles, contacts):
        """The fields of output.stress_fields from what the snapshot holds, (6.1)-(6.8)."""
        stress = shot.particles["stress"]
        np.testing.assert_allclose(particles["stress"], stress[:, [0, 1, 2, 5, 3, 4]].astype("f4"), rtol=1e-6)
        if "neck_radius" not in shot.contacts:
            return
        force, necked = shot.contacts["normal_force"], shot.contacts["phase"] > 0
        with np.errstate(divide="ignore", invalid="ignore"):
            area = np.where(necked, np.pi * shot.contacts["neck_radius"] ** 2, np.nan)
        np.testing.assert_array_equal(contacts["phase"], shot.contacts["phase"])
        np.testing.assert_allclose(contacts["neck_stress"], force / area, rtol=1e-6)
        np.testing.assert_allclose(contacts["neck_sintering_stress"], shot.contacts["sintering_force"] / area, rtol=1e-6)
        # Only central forces: the trace of a particle's sintering stress is sum F_sint (r + u/2) over its contacts.
        r, overlap = shot.particles["radius"], shot.contacts["overlap"]
        mean = np.zeros(len(r))
        for end in ("first_id", "second_id"):
            at = shot.contacts[end]
            distance = overlap + r[shot.contacts["first_id"]] + r[shot.contacts["second_id"]]
            other = r[shot.contacts["first_id"]] + r[shot.contacts["second_id"]] - r[at]
            arm = 0.5 * (distance + r[at] - other)
            np.add.at(mean, at, shot.contacts["sintering_force"] * arm)
        mean /= 4 * np.pi * r**3
        scale = np.abs(mean).max()
        np.testing.assert_allclose(particles["sintering_mean_stress"], mean, rtol=1e-5, atol=1e-6 * scale)
        parts = particles["sintering_mean_stress"].astype(float) + particles["viscoelastic_mean_stress"]
        whole = stress[:, :3].sum(axis=1) / 3
        np.testing.assert_allclose(parts, whole, rtol=1e-5, atol=1e-6 * np.abs(whole).max() + 1e-6 * scale)

    def test_vtk_reads_them(self):
        try:
            import vtk
        except ImportError:
            self.skipTest("the Python module vtk is missing")
        for kind, cells in (("particles", "GetNumberOfVerts"), ("contacts", "GetNumberOfLines")):
            path = FOLDER / f"periodic/paraview/{kind}_000002.vtp"
            sizes, arrays = read_vtp(path)
            reader = vtk.vtkXMLPolyDataReader()
            reader.SetFileName(str(path))
            reader.Update()
            data = reader.GetOutput()
            self.assertEqual(data.GetNumberOfPoints(), sizes["NumberOfPoints"])
            self.assertEqual(getattr(data, cells)(), max(sizes["NumberOfVerts"], sizes["NumberOfLines"]))
            self.assertEqual(data.GetPoint(3), tuple(arrays["Points"][3]))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
