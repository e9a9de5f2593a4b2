# SPDX-License-Identifier: MIT
"""Kills runs at random instants, resumes them, and compares with the whole run.

    kill_and_resume.py DELF --scenes collision "breather --scheme.method=composition" … --kills N      by kill -9
    kill_and_resume.py DELF --scenes … --half                       ends at half of the steps, and goes on
    kill_and_resume.py DELF --scenes … --age SECONDS                kills a long run then: how old are its last rows?

--arguments=--KEY=VALUE is of all scenes. Datasets of fields.h5, series.csv, section.csv and scene.ini must be equal to the
bit, summary.json but for timings. With --kills a run checkpoints as often as it can, is killed and resumed N times, and then
resumed to its end.
"""
import argparse
import json
import pathlib
import random
import shlex
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

timings = {"seconds", "ns_per_site_step"}


def datasets(path):
    with h5py.File(path, "r") as file:
        found = {name: data[()] for name, data in file.items()}
        return found, dict(file.attrs)


def differences(whole, resumed):
    wrong = []
    for name in ("series.csv", "section.csv", "scene.ini"):
        a, b = whole / name, resumed / name
        if a.exists() != b.exists() or (a.exists() and a.read_bytes() != b.read_bytes()):
            wrong.append(name)
    if (whole / "fields.h5").exists():
        (a, of_a), (b, of_b) = datasets(whole / "fields.h5"), datasets(resumed / "fields.h5")
        if a.keys() != b.keys():
            wrong.append("names of datasets")
        else:
            wrong += ["/" + n for n in a if a[n].shape != b[n].shape or a[n].tobytes() != b[n].tobytes()]
        wrong += [f"attribute {n}" for n in of_a if of_a[n] != of_b.get(n)]
    a, b = (json.loads((folder / "summary.json").read_text()) for folder in (whole, resumed))
    wrong += [f"summary.{n} ({a[n]} and {b.get(n)})" for n in a if n not in timings and a[n] != b.get(n)]
    return wrong


def run(delf, *arguments, expect=0):
    ran = subprocess.run([delf, *arguments], capture_output=True, text=True)
    if ran.returncode != expect:
        sys.exit(f"{arguments}: exit code {ran.returncode}\n{ran.stderr}")
    return ran


def steps_of(folder):
    return json.loads((folder / "summary.json").read_text())["steps"]


def halves(delf, scene, arguments, work):
    whole, half = work / "whole", work / "half"
    first = subprocess.run([delf, "run", scene, *arguments, "--out", whole], capture_output=True, text=True)
    if first.returncode != 0:
        return [f"the whole run: {first.stderr.strip()}"]
    steps = steps_of(whole)
    every = next(line for line in (whole / "scene.ini").read_text().splitlines() if line.startswith("every"))
    every = every.split("=")[1].strip()
    given = [a for a in arguments if not a.startswith(("--run.", "--output.every"))] + [f"--output.every={every}"]
    run(delf, "run", scene, *given, f"--run.steps={steps // 2}", "--out", half)
    run(delf, "resume", half, f"--run.steps={steps}")
    return differences(whole, half)


def kills(delf, scene, arguments, work, count, rng):
    whole, cut = work / "whole", work / "cut"
    begin = time.monotonic()
    run(delf, "run", scene, *arguments, "--output.checkpoint=1e-6", "--out", whole)
    seconds = time.monotonic() - begin
    command, done = [delf, "run", scene, *arguments, "--output.checkpoint=1e-6", "--out", cut], 0
    while done < count:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            process.wait(rng.uniform(0, 1.2 * seconds / max(1, min(count, 4))))
        except subprocess.TimeoutExpired:
            process.kill()
        error = process.communicate()[1]
        finished = process.returncode == 2 and "the run is finished" in error  # killed after its last file
        if process.returncode not in (0, -9) and not finished:
            return done, [f"exit code {process.returncode} after {done} kills: {error.strip()}"]
        if process.returncode == 0 or finished:
            wrong = differences(whole, cut)
            if wrong:
                return done, wrong
            command = [delf, "run", scene, *arguments, "--output.checkpoint=1e-6", "--out", cut]
            continue
        done += 1
        if any((cut / name).exists() for name in ("checkpoint", "checkpoint.previous")):
            command = [delf, "resume", cut]
    if command[1] == "resume":
        ran = subprocess.run(command, capture_output=True, text=True)
        if ran.returncode != 0 and "the run is finished" not in ran.stderr:
            return done, [f"after {done} kills: {ran.stderr.strip()}"]
    else:
        run(*command)
    return done, differences(whole, cut)


def age_of_rows(delf, scene, arguments, work, seconds):
    """How long before it was killed a run, which has no end and writes no checkpoint, last wrote rows."""
    cut = work / "cut"
    command = [delf, "run", scene, *arguments, "--run.steps=1000000000", "--output.every=1000", "--output.checkpoint=0"]
    command += ["--output.figures=off", "--out", cut]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(seconds)
    if process.poll() is not None:
        sys.exit(f"{scene}: ended with exit code {process.returncode} before it was killed")
    process.kill()
    killed = time.time()
    process.wait()
    return max(killed - (cut / name).stat().st_mtime for name in ("series.csv", "fields.h5"))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("delf")
    parser.add_argument("--scenes", nargs="+", required=True)
    parser.add_argument("--half", action="store_true")
    parser.add_argument("--kills", type=int, default=0)
    parser.add_argument("--age", type=float, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--arguments", action="append", default=[])
    asked = parser.parse_args()
    rng = random.Random(asked.seed)
    failed, killed = 0, 0
    for name in asked.scenes:
        scene, *own = shlex.split(name)
        arguments = own + asked.arguments
        with tempfile.TemporaryDirectory() as work:
            work = pathlib.Path(work)
            wrong = []
            if asked.half:
                wrong += halves(asked.delf, scene, arguments, work)
            if asked.kills:
                count, different = kills(asked.delf, scene, arguments, work, asked.kills, rng)
                killed, wrong = killed + count, wrong + different
            if asked.age:
                age = age_of_rows(asked.delf, scene, arguments, work, asked.age)
                print(f"{name}: killed after {asked.age:g} s, its last rows {age:.1f} s old")
                wrong += ["rows are lost that are older than 10 s"] if age > 10.5 else []
            if wrong:
                failed += 1
                print(f"{name}: {'; '.join(wrong)}")
    print(f"{len(asked.scenes)} scenes, {killed} kills, {failed} different")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
