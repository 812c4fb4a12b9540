"""Run the cases of an example once each and remember what they cost.

    from cases import run_case
    cost = run_case(scene, folder, ["integration.mass_scaling=1e14"])   # {"seconds", "steps", "time"}
"""

import json
import pathlib
import resource
import shutil
import subprocess

from densify_results import Results

ROOT = pathlib.Path(__file__).resolve().parents[2]


def build():
    """Builds the program, so that no case is charged for it."""
    subprocess.run([ROOT / "densify", "--version"], check=True, stdout=subprocess.DEVNULL)


def run_case(scene, folder, settings=(), again=False):
    """Runs a scene into the folder unless its results are there; returns user time [s], steps and process time [s]."""
    folder = pathlib.Path(folder)
    note = folder / "cost.json"
    if again or not note.exists():
        shutil.rmtree(folder, ignore_errors=True)
        command = [ROOT / "densify", "run", scene, "--out", folder, "--quiet"]
        for setting in settings:
            command += ["--set", setting]
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        subprocess.run(command, check=True)
        seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        history = Results(folder).history
        cost = {"seconds": seconds, "steps": int(history["steps"][-1]), "time": float(history["time_s"][-1])}
        note.write_text(json.dumps(cost))
    return json.loads(note.read_text())
