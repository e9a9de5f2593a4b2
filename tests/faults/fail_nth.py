#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The N-th allocation, write, fsync or rename of a run fails, for many N: no crash, the right exit code, one line that says
why, and nothing lost of what had been recorded.

    fail_nth.py PROGRAM LIBRARY [--kinds alloc,write,fsync,rename] [--most 200]
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

RUN = ["run", "kink", "--lattice.sites=64", "--run.steps=60", "--output.every=1", "--output.figures=off",
       "--output.checkpoint=1e-9", "--out"]


def run(program, library, folder, fail):
    environment = dict(os.environ, LD_PRELOAD=library, DELF_FAIL=fail, DELF_FAIL_COUNT=str(folder) + ".count")
    ran = subprocess.run([program, *RUN, str(folder)], env=environment, capture_output=True, text=True, timeout=60)
    count = pathlib.Path(str(folder) + ".count")
    return ran, int(count.read_text()) if count.exists() else 0


def lines_of(folder):
    series = folder / "series.csv"
    return series.read_text().splitlines() if series.exists() else []


def faults_of(ran, folder, whole):
    """What is wrong with how a run took its fault, in words."""
    found = []
    if ran.returncode not in (0, 4):
        found.append(f"exit code {ran.returncode}")
    said = ran.stderr.splitlines()
    if ran.returncode == 4 and len(said) == 0:
        found.append("exit code 4 without a word")
    if any("terminate called" in line for line in said):
        found.append("terminated")
    rows = lines_of(folder)
    if rows[: len(whole)] != whole[: len(rows)] and rows[:-1] != whole[: len(rows) - 1]:
        found.append("series.csv has other rows")
    if ran.returncode == 0 and rows != whole:
        found.append("exit code 0, and series.csv is not whole")
    summary = folder / "summary.json"
    if ran.returncode == 0 and not summary.exists():
        found.append("exit code 0 without summary.json")
    if summary.exists():
        try:
            json.loads(summary.read_text())
        except ValueError:
            found.append("summary.json is torn")
    return found


def resumed(program, folder, whole):
    """What is wrong with going on from what a failed run left, in words."""
    if not (folder / "checkpoint").exists():
        return []
    ran = subprocess.run([program, "resume", str(folder)], capture_output=True, text=True, timeout=60)
    if ran.returncode == 2 and "the run is finished" in ran.stderr:
        return []
    if ran.returncode != 0:
        return [f"cannot be resumed: exit code {ran.returncode}: {ran.stderr.strip()}"]
    return [] if lines_of(folder) == whole else ["resumed, and series.csv has other rows"]


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("program")
    arguments.add_argument("library")
    arguments.add_argument("--kinds", default="alloc,write,fsync,rename")
    arguments.add_argument("--most", type=int, default=200)
    asked = arguments.parse_args()
    wrong = tried = in_hdf5 = 0
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        for kind in asked.kinds.split(","):
            ran, count = run(asked.program, asked.library, work / f"whole-{kind}", f"{kind}:0")
            whole = lines_of(work / f"whole-{kind}")
            if ran.returncode != 0 or len(whole) != 62 or count == 0:
                sys.exit(f"the run without a fault: exit code {ran.returncode}, {len(whole)} lines, {count} calls: {ran.stderr}")
            step = max(1, count // asked.most)
            codes = {}
            for n in range(1, count + 1, step):
                for later in ("", "+") if kind != "alloc" else ("",):
                    folder = work / f"{kind}-{n}{later}"
                    ran, _ = run(asked.program, asked.library, folder, f"{kind}:{n}{later}")
                    tried += 1
                    codes[ran.returncode] = codes.get(ran.returncode, 0) + 1
                    # HDF5 1.10 has no mercy with itself: without memory for its own start it calls itself without end
                    # (H5I_inc_ref), and it takes the length of a name that it could not copy (H5O_attr_shared_size).
                    if kind == "alloc" and ran.returncode == -11:
                        in_hdf5 += 1
                        continue
                    faults = faults_of(ran, folder, whole)
                    if ran.returncode == 4:
                        faults += resumed(asked.program, folder, whole)
                    for fault in faults:
                        wrong += 1
                        print(f"{kind}:{n}{later}: {fault}: {ran.stderr.strip()[:200]}")
            print(f"{kind}: {count} calls, every {step}. fails; exit codes {codes}")
    print(f"{tried} runs, {wrong} wrong, {in_hdf5} crashed in HDF5")
    sys.exit(1 if wrong or in_hdf5 > max(1, tried // 50) else 0)


if __name__ == "__main__":
    main()
