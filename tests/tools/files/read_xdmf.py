# SPDX-License-Identifier: MIT
"""read_xdmf.py DELF FOLDER, by pvbatch: runs six scenes in FOLDER, and kills a seventh run, opens their fields.xdmf in ParaView, and compares ten
values of each with those of fields.h5, which h5py reads."""
import os
import signal
import subprocess
import sys
import time

import h5py
from paraview import simple

program, folder = sys.argv[1:3]
os.makedirs(folder, exist_ok=True)
wrong = 0


def fail(message):
    global wrong
    wrong += 1
    print("wrong:", message)


def blocks(data):
    """The grids of a data set: itself, or the leaves of one with blocks."""
    if not hasattr(data, "GetNumberOfBlocks"):
        return [data] if hasattr(data, "GetPointData") else []
    return [leaf for n in range(data.GetNumberOfBlocks()) for leaf in blocks(data.GetBlock(n)) if leaf is not None]


def kill_a_run(out):
    """Leaves what a run of a day has written when it is killed, and what `delf xdmf` makes of it."""
    checkpoint = os.path.join(out, "checkpoint")
    if os.path.exists(checkpoint):
        os.remove(checkpoint)
    run = subprocess.Popen([program, "run", "collision", "--run.until=1e6", "--output.every=20", "--output.checkpoint=0.1",
                            "--output.figures=off", "--out", out], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while not os.path.exists(checkpoint) and run.poll() is None:
        time.sleep(0.05)
    run.send_signal(signal.SIGKILL)
    run.wait()
    subprocess.run([program, "xdmf", out], check=True, stdout=subprocess.DEVNULL)


for scene in ("collision", "coupled-sine-gordon", "gauss-kink", "kdv", "r-adaptive", "sphere", "killed"):
    out = os.path.join(folder, scene)
    length = "--run.steps=40" if scene in ("r-adaptive", "kdv", "gauss-kink") else "--run.until=4"
    if scene == "killed":
        kill_a_run(out)
    else:
        subprocess.run([program, "run", scene, length, "--output.every=2", "--output.figures=off", "--output.xdmf=on", "--out", out],
                       check=True, stdout=subprocess.DEVNULL)
    with h5py.File(os.path.join(out, "fields.h5")) as file:
        field, times = file["field"][:], file["time"][:]
        names = file["field"].attrs.get("components", b"phi")
        name = (names.decode() if isinstance(names, bytes) else str(names)).split(",")[0]
    frames, sites = field.shape[:2]
    for reader_of in (simple.Xdmf3ReaderS, simple.XDMFReader):
        which = f"{scene} by {reader_of.__name__}"
        compared = 0
        # frame n of a grid of one row, and of one of all rows
        for name_of_file, points in (("fields", sites), ("surface", sites * frames)):
            path = os.path.join(out, name_of_file + ".xdmf")
            if not os.path.exists(path):
                if scene != "sphere":
                    fail(f"{which}: there is no {path}")
                continue
            reader = reader_of(FileName=[path]) if reader_of is simple.Xdmf3ReaderS else reader_of(FileNames=[path])
            for n in (frames - 1, frames // 2):
                reader.UpdatePipeline(float(times[n]))
                # not by servermanager.Fetch, which damages the end of rectilinear grids (ParaView 5.11)
                grids = [g for g in blocks(reader.GetClientSideObject().GetOutputDataObject(0)) if g.GetNumberOfPoints() == points]
                values = grids[0].GetPointData().GetArray(name) if grids else None
                if values is None:
                    fail(f"{which}: {path} has no {name} at {points} points")
                    continue
                for i in range(0, sites, max(1, sites // 10)):
                    compared += 1
                    read = values.GetValue(i + (n * sites if points > sites else 0))
                    if abs(read - field[n, i, 0]) > 1e-12 * abs(field[n]).max():
                        fail(f"{which}: {name} of site {i} in frame {n} of {path} is {read}, not {field[n, i, 0]}")
            simple.Delete(reader)
        print(f"{which}: {compared} values compared, {frames} frames, {sites} sites")
sys.exit(1 if wrong else 0)
