# SPDX-License-Identifier: MIT
"""A wheel in a fresh environment: wheel.py SOURCE BUILD WORK. Its checks, its program, the lines of the README, and a C++
program with the headers in it. BUILD is a build tree, of which the wheel is made; or a folder for the builds of a wheel for
any processor, which give the same bits: every scene is run with each of them that this processor can take."""
import glob
import os
import re
import shutil
import subprocess
import sys

source, build, work = map(os.path.abspath, sys.argv[1:])
shutil.rmtree(work, ignore_errors=True)
os.makedirs(work)


def run(*words, **options):
    print("+", *words, flush=True)
    return subprocess.run(words, check=True, text=True, cwd=work, **options)


run(sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-index", "--no-cache-dir", "-q", "-w", work, source,
    "--config-settings", f"build-dir={build}")
(wheel,) = glob.glob(os.path.join(work, "*.whl"))
print(os.path.basename(wheel), os.path.getsize(wheel) >> 20, "MiB")
run(sys.executable, "-m", "venv", "--system-site-packages", "venv")  # NumPy is the system's
python = os.path.join(work, "venv", "bin", "python3")
run(python, "-m", "pip", "install", "--no-deps", "--no-index", "-q", wheel)
run(python, "-m", "delf", "test")
out = run(python, "-m", "delf", "run", "collision", "--run.until=1", "--output.figures=off", "--out", "made",
          capture_output=True).stdout
assert "collision: sine-gordon" in out, out
run(os.path.join(work, "venv", "bin", "delf"), "--version")
with open(os.path.join(source, "README.md"), encoding="utf-8") as file:
    (lines,) = re.findall(r"```python\n(.*?)```", file.read(), re.S)
out = run(python, "-c", lines, capture_output=True).stdout
assert "Run collision: done" in out and "FAIL" not in out, out
prefix = run(python, "-c", "import delf; print(delf.prefix())", capture_output=True).stdout.strip()
run("cmake", "-S", os.path.join(source, "tests", "package"), "-B", "consumer", "-G", "Ninja",
    f"-DCMAKE_PREFIX_PATH={prefix}")
run("cmake", "--build", "consumer")
for consumer in ("consumer", "consumer_of_lattice"):
    assert run(f"consumer/{consumer}", capture_output=True).stdout.startswith("0.1568627450980392")

levels = run(python, "-c", "from delf._processor import *; print(*(name for name in BUILT if LEVELS[name] <= flags()))",
             capture_output=True).stdout.split()
BITS = """
import hashlib, warnings, delf
warnings.simplefilter("ignore")
print(delf.program())
for scene in delf.scenes():
    try:
        run = delf.run(scene, steps=40, every=1)
    except delf.BadInput:  # a scene without steps
        run = delf.run(scene)
    bits = hashlib.sha256(b"".join(array.tobytes() for array in (run.series, *run.fields.values())))
    print(scene, run.status, len(run.series), bits.hexdigest())
for scene in ("collision", "kink", "spherical-pendulum"):
    checks = delf.verify(scene, steps=40).checks
    print("verify", scene, hashlib.sha256(checks.tobytes()).hexdigest())
"""
if levels:
    bits = {level: run(python, "-c", BITS, capture_output=True, env={**os.environ, "DELF_CPU": level}).stdout.splitlines()
            for level in ("x86-64", *levels)}
    assert len({lines[0] for lines in bits.values()}) == 1 + len(levels), bits  # programs of their own
    for level in levels:
        other = [line for line, same in zip(bits[level][1:], bits["x86-64"][1:]) if line != same]
        assert not other, f"{level} has other bits than x86-64: {other}"
    assert len(bits["x86-64"]) > 20, bits
    print(len(bits["x86-64"]) - 1, "results, the same to the bit:", *bits)
    chosen = run(python, "-c", "import delf; print(delf.program())", capture_output=True).stdout.strip()
    assert chosen == bits[levels[-1]][0], chosen
    bad = subprocess.run([python, "-m", "delf"], env={**os.environ, "DELF_CPU": "fast"}, capture_output=True, text=True)
    assert "DELF_CPU = fast: this package has no such build; take x86-64 or" in bad.stderr.splitlines()[-1], bad
