#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What the shipped scenes cost at their start: the table in tools/bench/README.md. From the top folder:

    tools/lean.py                                  prints the table
    tools/lean.py --update tools/bench/README.md   puts it between the two markers there
    tools/lean.py --check tools/bench/README.md    exit code 1 unless its scenes, and what they leave out, still hold

Files opened are counted by strace and are `?` without it; heap and libraries are read from /proc, so from Linux.
"""
import argparse
import fcntl
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import textwrap
import time

BEGIN, END = "<!-- lean table begins -->", "<!-- lean table ends -->"
EXPLICIT = "collision --lattice.stencil=triangle-vertex"
QUIET = ["--output.figures=off", "--output.fields=off"]
FEW = "--run.steps=16"  # seeds have reached their order, and what is allocated once is there
HEAD = ["scene", "rows, B", "other arrays, B", "heap, kB", "files", "libraries", "start-up, ms", "left out"]


class Refused(Exception):
    """What cannot be measured, in words for whoever asked."""


def scene_names(listing):
    """The names in the output of `delf list scenes`.

    >>> scene_names('''scenes
    ...   breather     A breather of sine-Gordon: two solitons.
    ...   kink-train   A train of kinks.
    ... ''')
    ['breather', 'kink-train']
    """
    return re.findall(r"^ +([\w-]+) ", listing, re.MULTILINE)


def planned(plan):
    """Bytes of the rows (fields and increments) and of all other arrays, at the end of a run that records rows, and
    what is left out, as `delf plan` says.

    >>> text = '''  left out   fields.h5: HDF5 is not touched
    ... memory       39.6 kB, 39628 bytes: rows of the field 6528 B, increments 17408 B, nonlinear terms 4352 B, matrix 2432 B, \
work space 6732 B, monitors 2176 B
    ... left out     any matrix, Jacobians of the full Newton method, until a step needs one, nodes inside cells
    ... '''
    >>> planned(text)[:2]
    (23936, 15692)
    >>> for what in planned(text)[2]: print(what)
    fields.h5: HDF5 is not touched
    any matrix
    Jacobians of the full Newton method, until a step needs one
    nodes inside cells
    >>> planned("memory       24 bytes: rows of the section 8 B, stencils 12 B, Jacobian and factors 4 B")[:2]
    (8, 16)
    >>> planned("memory       25 bytes: rows of the field 8 B, matrix 12 B")
    Traceback (most recent call last):
    ...
    lean.Refused: the parts of the memory are 20 bytes, and the plan says 25
    >>> planned("solve        explicit")
    Traceback (most recent call last):
    ...
    lean.Refused: the plan says nothing of memory
    """
    memory = re.search(r"^ *memory +(?:[\d.]+ k?M?G?B, )?(\d+) bytes: (.*)$", plan, re.MULTILINE)
    if not memory:
        raise Refused("the plan says nothing of memory")
    parts = {name: int(size) for name, size in re.findall(r"([^,]+?) (\d+) B(?:, |$)", memory[2])}
    total = sum(parts.values())
    if total != int(memory[1]):
        raise Refused(f"the parts of the memory are {total} bytes, and the plan says {memory[1]}")
    rows = sum(size for name, size in parts.items() if name.startswith("rows of ") or name == "increments")
    left_out = re.findall(r"^  left out +(.*)$", plan, re.MULTILINE)
    for line in re.findall(r"^left out +(.*)$", plan, re.MULTILINE):
        left_out += re.split(r", (?!until )", line)
    return rows, total - rows, left_out


def is_library(path):
    """
    >>> [is_library(p) for p in ("/lib/libm.so.6", "/lib64/ld-linux-x86-64.so.2", "/usr/lib/libfmt.so", "a/scene.ini")]
    [True, True, True, False]
    """
    return re.search(r"\.so(\.[\d.]+)?$", path) is not None


def files_opened(trace):
    """The files that were opened, without shared libraries and the loader's list of them, in the output of strace.

    >>> files_opened('''1 openat(AT_FDCWD, "/etc/ld.so.cache", O_RDONLY|O_CLOEXEC) = 3
    ... 1 openat(AT_FDCWD, "haswell/libm.so.6", O_RDONLY|O_CLOEXEC) = -1 ENOENT (No such file or directory)
    ... 1 openat(AT_FDCWD, "/lib/libm.so.6", O_RDONLY|O_CLOEXEC) = 3
    ... 1 openat(AT_FDCWD, "scene.ini", O_RDONLY) = 3
    ... 1 openat(AT_FDCWD, "scene.ini", O_RDONLY) = 3
    ... 1 open("out/summary.json", O_WRONLY|O_CREAT|O_TRUNC, 0666) = 4
    ... 1 openat(AT_FDCWD, "none.csv", O_RDONLY) = -1 ENOENT (No such file or directory)
    ... 1 +++ exited with 0 +++
    ... ''')
    ['out/summary.json', 'scene.ini']
    """
    opened = re.findall(r'(?:open|openat|openat2|creat)\((?:[^"]*, )?"([^"]*)".* = \d+$', trace, re.MULTILINE)
    return sorted({path for path in opened if not is_library(path) and path != "/etc/ld.so.cache"})


def mapped(maps):
    """Bytes of the heap, and how many shared libraries there are, in a /proc/PID/maps.

    >>> mapped('''55d9-55da r-xp 00000000 08:01 12 /usr/bin/delf
    ... 55d98d67f000-55d98d680000 rw-p 00000000 00:00 0                          [heap]
    ... 7f10-7f11 r--p 00000000 08:01 34 /lib/x86_64-linux-gnu/libm.so.6
    ... 7f11-7f12 r-xp 00001000 08:01 34 /lib/x86_64-linux-gnu/libm.so.6
    ... 7f20-7f21 r--p 00000000 08:01 35 /lib/x86_64-linux-gnu/ld-linux-x86-64.so.2
    ... 7ffd-7ffe r-xp 00000000 00:00 0 [vdso]
    ... ''')
    (4096, 2)
    """
    heap, libraries = 0, set()
    for line in maps.splitlines():
        words = line.split()
        if len(words) < 6:
            continue
        if words[5] == "[heap]":
            first, last = (int(address, 16) for address in words[0].split("-"))
            heap += last - first
        elif is_library(words[5]):
            libraries.add(words[5])
    return heap, len(libraries)


def letter(number):
    return "abcdefghijklmnopqrstuvwxyz"[number]


def lettered(left_out):
    """For each scene the letters of what it leaves out; and a line that says what they and all others leave out.

    >>> cells, line = lettered([["matrix", "figures"], ["figures"], ["figures", "seeds", "matrix"]])
    >>> cells
    ['a', '–', 'a b']
    >>> line
    'Left out by all: figures. Left out besides: (a) matrix; (b) seeds.'
    """
    common = [what for what in left_out[0] if all(what in others for others in left_out)]
    further = list(dict.fromkeys(what for others in left_out for what in others if what not in common))
    cells = [" ".join(letter(n) for n, what in enumerate(further) if what in others) or "–" for others in left_out]
    line = f"Left out by all: {'; '.join(common) or 'nothing'}."
    if further:
        line += " Left out besides: " + "; ".join(f"({letter(n)}) {what}" for n, what in enumerate(further)) + "."
    return cells, line


def spread(milliseconds):
    """Median, and the quartiles around it.

    >>> spread([3.0, 1.0, 2.0, 100.0, 4.0])
    '3.0 (2.0–4.0)'
    >>> spread([5.0])
    '5.0 (5.0–5.0)'
    """
    if len(milliseconds) == 1:
        low = middle = high = milliseconds[0]
    else:
        low, middle, high = statistics.quantiles(milliseconds, n=4, method="inclusive")
    return f"{middle:.1f} ({low:.1f}–{high:.1f})"


def in_markdown(rows):
    return "\n".join("| " + " | ".join(row) + " |" for row in [HEAD, ["---"] * len(HEAD)] + rows)


def updated(page, block):
    """The page with the block between the markers, whatever stood there.

    >>> print(updated(f"above\\n{BEGIN}\\nold\\n{END}\\nbelow", "new").replace("<!-- ", "").replace(" -->", ""))
    above
    lean table begins
    <BLANKLINE>
    new
    <BLANKLINE>
    lean table ends
    below
    >>> updated("no markers", "new")
    Traceback (most recent call last):
    ...
    lean.Refused: needs the markers <!-- lean table begins --> and <!-- lean table ends -->, once each
    """
    if page.count(BEGIN) != 1 or page.count(END) != 1 or page.index(BEGIN) > page.index(END):
        raise Refused(f"needs the markers {BEGIN} and {END}, once each")
    return page[:page.index(BEGIN) + len(BEGIN)] + f"\n\n{block}\n\n" + page[page.index(END):]


def words_of(page):
    """What the table of a page says on any machine: scenes and what they leave out, then what the letters stand for.

    >>> words_of(f"{BEGIN}\\n| scene | B | left out |\\n|---|---|---|\\n| `kink` | 8 | a |\\n\\n1 ms\\n\\n"
    ...          f"Left out by all:\\nx.\\n\\n{END}")
    ['`kink`: a', 'Left out by all: x.']
    """
    if BEGIN not in page or END not in page:
        raise Refused(f"has no table between {BEGIN} and {END}")
    block = page[page.index(BEGIN):page.index(END)]
    lines = [line for line in block.splitlines() if line.startswith("| `")]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    paragraphs = [" ".join(paragraph.split()) for paragraph in block.split("\n\n")]
    return [f"{row[0]}: {row[-1]}" for row in rows] + [words for words in paragraphs if words.startswith("Left out")]


class Program:
    """The built program, run in a folder of its own."""

    def __init__(self, path, folder):
        found = shutil.which(path)
        if not found:
            raise Refused(f"{path}: no such program; build it, or name it by --program")
        self.path, self.folder = str(pathlib.Path(found).resolve()), folder

    def says(self, *words):
        """What it prints."""
        ran = subprocess.run([self.path, *words], cwd=self.folder, capture_output=True, text=True)
        if ran.returncode != 0:
            raise Refused(f"delf {' '.join(words)}: {ran.stderr.strip() or ran.returncode}")
        return ran.stdout

    def milliseconds(self, *words):
        """From before it is started to after it has ended."""
        nowhere = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
        os.chdir(self.folder)
        begin = time.perf_counter()
        _, status = os.waitpid(os.posix_spawn(self.path, [self.path, *words], os.environ, file_actions=nowhere), 0)
        passed = 1e3 * (time.perf_counter() - begin)
        if status != 0:
            raise Refused(f"delf {' '.join(words)}: failed")
        return passed

    def mapped(self, *words):
        """Bytes of its heap at their most, and how many libraries it has loaded, when it is about to end.

        What it prints last goes into a pipe that is full already, so that it waits there to be checked. glibc's
        tunables have everything allocated from the heap, which then grows by pages and never shrinks.
        """
        tunables = {"mmap_max": 0, "top_pad": 0, "trim_threshold": 1 << 40}
        environment = dict(os.environ, GLIBC_TUNABLES=":".join(f"glibc.malloc.{k}={v}" for k, v in tunables.items()))
        reading, writing = os.pipe()
        os.write(writing, b" " * fcntl.fcntl(writing, fcntl.F_SETPIPE_SZ, 4096))
        process = subprocess.Popen([self.path, *words], cwd=self.folder, stdout=writing, env=environment,
                                   stderr=subprocess.DEVNULL)
        os.close(writing)
        proc, maps, asleep, deadline = pathlib.Path(f"/proc/{process.pid}"), "", 0, time.monotonic() + 60
        try:
            while asleep < 20 and process.poll() is None and time.monotonic() < deadline:
                time.sleep(1e-3)
                asleep = asleep + 1 if "State:\tS" in (proc / "status").read_text() else 0
            if asleep == 20:
                maps = (proc / "maps").read_text()
            while os.read(reading, 1 << 16):
                pass
        finally:
            os.close(reading)
            if process.wait() != 0 or not maps:
                raise Refused(f"delf {' '.join(words)}: could not be checked when it was about to end")
        return mapped(maps)

    def files(self, *words):
        """How many files it opens; None if strace is missing, or may not trace."""
        trace = pathlib.Path(self.folder) / "trace"
        if not shutil.which("strace"):
            return None
        ran = subprocess.run(["strace", "-f", "-qq", "-e", "trace=?open,openat,?openat2,?creat", "-o", str(trace),
                              self.path, *words], cwd=self.folder, capture_output=True)
        return len(files_opened(trace.read_text())) if ran.returncode == 0 and trace.exists() else None


def processor():
    """The processor's name."""
    found = re.search(r"^model name\s*: (.*)$", pathlib.Path("/proc/cpuinfo").read_text(), re.MULTILINE)
    return re.sub(r"\((R|TM)\)|CPU |@.*", "", found[1]).strip() if found else "a processor without a name"


def wrapped(words):
    return textwrap.fill(words, 120, break_long_words=False, break_on_hyphens=False)


def kilobytes(count):
    return f"{count / 1e3:.0f}"


def steps(scene, option):
    """The option, or none for a scene without steps."""
    path = pathlib.Path(__file__).parent / "scenes" / (scene.split()[0] + ".ini")
    is_timeless = path.exists() and re.search(r"^(time = none|mesh = refined:)", path.read_text(), re.MULTILINE)
    return [] if is_timeless else [option]


def run_words(scene, *more):
    return ["run", *scene.split(), *QUIET, *[word for option in more for word in steps(scene, option)], "--out", "out"]


def described(program, scenes):
    """Rows of the table without what is measured, and the line below it."""
    plans = [planned(program.says("plan", *scene.split(), *QUIET, *steps(scene, FEW))) for scene in scenes]
    cells, line = lettered([left_out for _, _, left_out in plans])
    rows = [[f"`{scene}`", str(own), str(other), "", "", "", "", cell]
            for scene, (own, other, _), cell in zip(scenes, plans, cells)]
    return rows, line


def measured(program, scenes, repeats):
    """The table, with what is needed to understand it."""
    rows, line = described(program, scenes)
    bare_heap, bare_libraries = program.mapped("--version")
    times = {scene: [] for scene in scenes}
    bare_times = []
    if os.getloadavg()[0] > 0.5 * (os.cpu_count() or 1):
        print("lean.py: the machine is busy: start-up is longer than it need be", file=sys.stderr)
    for _ in range(repeats):  # in turn, so that whatever else the machine does falls on all
        bare_times.append(program.milliseconds("--version"))
        for scene in scenes:
            times[scene].append(program.milliseconds(*run_words(scene, "--run.steps=0")))
    for scene, row in zip(scenes, rows):
        heap, libraries = program.mapped(*run_words(scene, FEW))
        files = program.files(*run_words(scene, FEW))
        row[3:7] = [kilobytes(heap - bare_heap), "?" if files is None else str(files), str(libraries),
                    spread(times[scene])]
    note = (f"Made by `tools/lean.py --update tools/bench/README.md` on {processor()}. "
            f"Scenes run with `{' '.join(QUIET)}`. Rows and other arrays are those that a run has at its end, as "
            f"`delf plan` predicts them: those of monitors and of the residual of recorded rows too. "
            f"Heap is the most that {FEW[12:]} recorded steps and their files need, in whole pages, over "
            f"the {kilobytes(bare_heap)} kB of `delf --version`, which takes {spread(bare_times)} ms with its "
            f"{bare_libraries} shared libraries, the loader among them. Start-up is a run of no steps, from starting "
            f"the program to its end: the median of {repeats}, and the quartiles.")
    return "\n\n".join([in_markdown(rows), wrapped(note), wrapped(line)])


def main():
    reader = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    reader.add_argument("--program", default="build/release/delf", help="the built program (%(default)s)")
    reader.add_argument("--repeats", type=int, default=20, help="runs that start-up is the median of (%(default)s)")
    what = reader.add_mutually_exclusive_group()
    what.add_argument("--update", metavar="PAGE", type=pathlib.Path, help="put the table between its markers")
    what.add_argument("--check", metavar="PAGE", type=pathlib.Path, help="compare what this page says with the program")
    reader.add_argument("scene", nargs="*", help="scenes of the table (an explicit one, and all that are shipped)")
    asked = reader.parse_args()
    for page in ("update", "check"):  # the folder is another one before long
        if getattr(asked, page):
            setattr(asked, page, getattr(asked, page).resolve())
    try:
        with tempfile.TemporaryDirectory(prefix="delf-lean-") as folder:
            program = Program(asked.program, folder)
            scenes = asked.scene or [EXPLICIT] + scene_names(program.says("list", "scenes"))
            if asked.check:
                rows, line = described(program, scenes)
                said = words_of(asked.check.read_text(encoding="utf-8"))
                now = words_of("\n\n".join([BEGIN, in_markdown(rows), line, END]))
                for lost in [w for w in said if w not in now]:
                    print(f"{asked.check} says, and it is not so: {lost}", file=sys.stderr)
                for new in [w for w in now if w not in said]:
                    print(f"{asked.check} does not say: {new}", file=sys.stderr)
                return 0 if said == now else 1
            if asked.update:
                updated(asked.update.read_text(encoding="utf-8"), "")  # refused before a long wait, if at all
            block = measured(program, scenes, max(1, asked.repeats))
            if not asked.update:
                print(block)
                return 0
            page = updated(asked.update.read_text(encoding="utf-8"), block)
            asked.update.write_text(page, encoding="utf-8")
            return 0
    except (Refused, OSError) as error:
        print(f"lean.py: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
