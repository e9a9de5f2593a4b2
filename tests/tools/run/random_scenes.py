# SPDX-License-Identifier: MIT
"""Runs random scenes beside finer runs of the same scene, and counts errors that a run does not report.

    random_scenes.py DELF [--count 1000] [--seed 1] [--limit 0.3] [--keep FOLDER]

A scene is a theory, a space, a scheme, a start and a step drawn at random, stiff and unstable ones too. Its reference is
the same scene with a quarter of the time step and half of the space step; the reference exists where a run finer by two
again is within 5 % of it. An error is silent if the last row is off by more than --limit times the largest value of the
reference while the run ended with exit code 0 and without a warning. --keep writes the silent scenes to a folder. Exit code 1 if
an error was silent, or a run did not end in two minutes.
"""
import argparse
import collections
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

import h5py
import numpy as np

agreement = 0.05
stencils = ["triangle", "triangle-vertex", "rectangle", "rectangle-symmetric", "hexagon", "six-tuple", "nine-tuple"]
tableaux = ["gauss1", "gauss2", "gauss3", "lobatto2", "lobatto3", "midpoint", "stormer-verlet"]


def between(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def field_scene(rng):
    """A field on a circle or an interval: keys of the scene, and the keys of a run that is finer by 2^level."""
    keys = {"theory.name": rng.choice(["wave", "klein-gordon", "sine-gordon", "sine-gordon", "phi4", "double-sine-gordon"])}
    length = rng.choice([10, 20, 40])
    circle = rng.random() < 0.6
    if keys["theory.name"] not in ("wave", "phi4"):
        keys["theory.mass"] = round(between(rng, 0.3, 8), 3)
    if keys["theory.name"] in ("phi4", "double-sine-gordon"):
        keys["theory.lambda"] = round(between(rng, 0.2, 5), 3)
    sites = 2 * rng.randrange(8, 120) + 1
    step = length / sites if circle else length / (sites - 1)
    keys |= {"lattice.space": "circle" if circle else "interval", "lattice.length": length}
    method = rng.choice(["stencil"] * 5 + ["composition", "processed", "cgvi", "radau-iia", "vu-quoc-li", "guo"])
    if method == "stencil":
        keys["lattice.stencil"] = rng.choice(stencils)
    else:
        keys["scheme.method"] = method
        if method == "cgvi":
            keys["scheme.tableau"] = rng.choice(tableaux)
    states = {"sine-gordon": ["breather", "kink-antikink", "formula"], "phi4": ["kink-antikink", "formula"],
              "double-sine-gordon": ["kink-antikink", "formula"]}
    linear = ["plane-wave", "formula"] + ["wave-packet"] * circle
    state = rng.choice(states.get(keys["theory.name"], linear))
    if state == "formula":
        wave = rng.randrange(1, 4)
        keys["initial.phi"] = f"{round(rng.uniform(0.1, 3), 3)}*{'cos' if circle else 'sin'}({wave}*{'2*' if circle else ''}pi*x/L)"
        keys["initial.phi_t"] = f"{round(rng.uniform(-1, 1), 3)}*sin({'2*' if circle else ''}pi*x/L)"
    else:
        keys["initial.state"] = state
        if state == "breather":
            keys["initial.frequency"] = round(rng.uniform(0.2, 0.95) * keys["theory.mass"], 3)
        if state == "kink-antikink":
            keys["initial.speed"] = round(rng.uniform(0.1, 0.9), 3)
    h = between(rng, 0.05, 2) * step
    steps = max(1, min(4000, round(between(rng, 0.5, 40) / h)))

    def finer(level):
        n = sites * 2**level if circle else (sites - 1) * 2**level + 1
        return {"lattice.sites": n, "lattice.time_step": repr(h / 4**level), "run.steps": steps * 4**level}

    return keys, finer, lambda field, level: field[:: 2**level]


def point_scene(rng):
    """A problem of mechanics."""
    name = rng.choice(["pendulum", "pendulum", "harmonic-oscillator", "kepler", "henon-heiles", "double-pendulum",
                       "lotka-volterra", "charged-particle"])
    keys = {"theory.name": name, "lattice.space": "point", "initial.state": "point"}
    u = lambda a, b: round(rng.uniform(a, b), 3)
    if name in ("lotka-volterra", "charged-particle"):
        keys |= {"scheme.method": "dgvi", "initial.q": f"{u(0.5, 2)}, {u(0.5, 2)}",
                 "scheme.functions": rng.choice([1, 2, 3])}
    else:
        if rng.random() < 0.3:
            keys["lattice.stencil"] = rng.choice(["midpoint", "trapezoidal"])
        else:
            keys |= {"scheme.method": "cgvi", "scheme.tableau": rng.choice(tableaux)}
        starts = {"pendulum": lambda: (u(-3, 3), u(-3, 3)), "harmonic-oscillator": lambda: (u(-2, 2), u(-2, 2)),
                  "kepler": lambda: (f"{u(0.4, 2)}, 0", f"0, {u(0.5, 1.3)}"),
                  "henon-heiles": lambda: (f"{u(-.3, .3)}, {u(-.3, .3)}", f"{u(-.2, .2)}, {u(-.2, .2)}"),
                  "double-pendulum": lambda: (f"{u(-1.5, 1.5)}, {u(-1.5, 1.5)}", f"{u(-1, 1)}, {u(-1, 1)}")}
        keys["initial.q"], keys["initial.v"] = starts[name]()
    h = between(rng, 0.01, 2)
    steps = max(1, min(4000, round(between(rng, 0.5, 40) / h)))
    finer = lambda level: {"lattice.time_step": repr(h / 4**level), "run.steps": steps * 4**level}
    return keys, finer, lambda field, level: field


def as_scene(keys):
    sections = collections.defaultdict(list)
    for key, value in keys.items():
        section, name = key.split(".")
        sections[section].append(f"{name} = {value}")
    return "".join(f"[{section}]\n" + "\n".join(lines) + "\n" for section, lines in sections.items())


def ran(delf, keys, folder):
    """Exit code, warnings and the last row of a run."""
    (scene := folder.with_suffix(".ini")).write_text(as_scene(keys))
    try:
        run = subprocess.run([delf, "run", str(scene), "--output.figures=off", f"--out={folder}"],
                             capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:
        return None, [], None
    if run.returncode != 0:
        return run.returncode, [run.stderr.strip()], None
    summary = json.loads((folder / "summary.json").read_text())
    with h5py.File(folder / "fields.h5", "r") as file:
        return 0, summary["warnings"], file["field"][-1]


def judged(delf, seed, folder, limit):
    rng = random.Random(seed)
    keys, finer, thinned = (field_scene if rng.random() < 0.6 else point_scene)(rng)
    code, warnings, row = ran(delf, keys | finer(0), folder / "coarse")
    scene = keys | finer(0)
    if code is None:
        return "no end in two minutes", scene, None
    if code == 2:
        return "refused: " + warnings[0].split(": ", 1)[-1][:60], scene, None
    if code != 0:
        return f"exit code {code}", scene, None
    rows = []
    for level in (1, 2):
        code, _, finer_row = ran(delf, keys | finer(level), folder / f"level{level}")
        if code != 0:
            return "no reference", scene, None
        rows.append(thinned(finer_row, level))
    size = max(np.abs(rows[0]).max(), 1e-300)
    if not np.abs(rows[1] - rows[0]).max() <= agreement * size:
        return "no reference", scene, None
    error = float(np.abs(row - rows[0]).max() / size)
    if error <= limit:
        return "right, with a warning" if warnings else "right", scene, error
    return "wrong, with a warning" if warnings else "wrong, silent", scene, error


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("delf")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--limit", type=float, default=0.3)
    parser.add_argument("--keep", type=pathlib.Path)
    options = parser.parse_args()
    counts = collections.Counter()
    for seed in range(options.seed, options.seed + options.count):
        with tempfile.TemporaryDirectory() as folder:
            verdict, scene, error = judged(options.delf, seed, pathlib.Path(folder), options.limit)
        counts[verdict] += 1
        if verdict in ("wrong, silent", "no end in two minutes"):
            off = "" if error is None else f", off by {100 * error:.0f} %"
            print(f"seed {seed}: {verdict}{off}: {' '.join(f'{key}={value}' for key, value in scene.items())}", flush=True)
            if options.keep:
                options.keep.mkdir(parents=True, exist_ok=True)
                (options.keep / f"{seed}.ini").write_text(as_scene(scene))
    for verdict, count in counts.most_common():
        print(f"{count:6} {verdict}")
    sys.exit(int(counts["wrong, silent"] + counts["no end in two minutes"] > 0))


if __name__ == "__main__":
    main()
