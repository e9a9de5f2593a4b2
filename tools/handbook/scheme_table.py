#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Schemes side by side, from what three commands of delf have written: scheme_table.py schemes.csv > TABLE.

A line of schemes.csv is NAME|KEYS|SOURCE. Read are workprecision/workprecision.json, stability/stability.json, and
verify/NAME/verify.json of every scheme.
"""

import json
import math
import pathlib
import sys

read = lambda path: json.loads(pathlib.Path(path).read_text())
work, limits = read("workprecision/workprecision.json"), read("stability/stability.json")["limits"]


def order(runs):
    """log2 of the errors of the last two of the runs, each at half of the steps of the one before, above rounding."""
    errors = [run["error_linf"] for run in sorted(runs, key=lambda run: run["sites"]) if run["error_linf"] > 1e-11]
    return f"{math.log2(errors[-2] / errors[-1]):.1f}" if len(errors) > 1 else "–"


def limit(name):
    found = next((one for one in limits if one["scheme"] == name), None)
    if found is None:
        return "–"
    return "none" if found["courant_theory"] is None else f"{found['courant_theory']:.3f}"


print("| scheme | order | forces | µs | error | h/k | form formula | energy | source |")
print("|---|--:|--:|--:|--:|--:|---|---|---|")
for line in pathlib.Path(sys.argv[1]).read_text().splitlines():
    name, _, source = line.split("|")
    runs = [run for run in work["runs"] if run["scheme"].removesuffix(" (scene's)") == name]
    finest = max(runs, key=lambda run: run["sites"])
    checks = read(f"verify/{name}/verify.json")
    forms = [check["passed"] for check in checks["checks"] if check["name"].startswith("form formula")]
    own = checks["energy_own"]
    drift = abs(own["last"] / own["first"] - 1) if own else None
    keeps = "–" if own is None else "to rounding" if drift < 1e-13 else f"to {drift:.0e}"
    print(f"| {name} | {order(runs)} | {finest['forces_per_step']:.3g} | {1e6 * finest['seconds'] / finest['steps']:.3g} | "
          f"{finest['error_linf']:.1e} | {limit(name)} | {'holds' if all(forms) else 'fails'} | {keeps} | {source} |")
