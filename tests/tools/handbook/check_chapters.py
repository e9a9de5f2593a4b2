#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check_chapters.py DELF SOURCE WORK: the chapters of the handbook are made, and a chapter that is wrong is refused by line."""

import pathlib
import subprocess
import sys
import tempfile

delf, source, work = sys.argv[1:]
make = [sys.executable, pathlib.Path(source) / "tools/handbook/handbook.py", delf]
refusals = {
    "unknown-key.md:3": "lattice.site",
    "no-such-line.md:6": "prints no such line",
    "no-such-figure.md:7": "no command makes the figure results/kink/figures/spacetime.svg",
    "made-up-number.md:7": "no command prints 3.14",
    "no-such-page.md": "there.md: no such file",
}
for place, words in refusals.items():
    with tempfile.TemporaryDirectory() as folder:
        name = place.split(":")[0]
        (pathlib.Path(folder) / name).write_text((pathlib.Path(__file__).parent / "broken" / name).read_text())
        ran = subprocess.run([*make, f"{folder}/work", folder], capture_output=True, text=True)
        if ran.returncode == 0 or place not in ran.stderr or words not in ran.stderr:
            sys.exit(f"{name} is not refused at {place} for {words!r}: {ran.stdout}{ran.stderr}")
sys.exit(subprocess.run([*make, work]).returncode)
