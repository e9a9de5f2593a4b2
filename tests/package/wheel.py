# SPDX-License-Identifier: MIT
"""The wheel, made of a build tree, in a fresh environment: wheel.py SOURCE BUILD WORK. Its checks, its program, the lines
of the README, and a C++ program with the headers in it."""
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
