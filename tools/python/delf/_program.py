# SPDX-License-Identifier: MIT
"""The program delf, for the commands whose results are tables: in a folder of its own, which is removed behind it."""
from __future__ import annotations

import contextlib
import csv
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import warnings
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Union

import numpy as np

from . import _delf
from ._errors import BadInput, CheckFailed, Error, NumericsFailed, SystemFailed, here
from ._processor import CHOSEN, HERE
from ._scene import Scene, scene_of, texts_of

# Options beside **keys take Any: a dictionary of keys, **{"lattice.sites": 401}, might hold any of them to a type checker.
SceneLike = Union[Scene, str, "os.PathLike[str]", None]


def prefix() -> str:
    """The folder for CMAKE_PREFIX_PATH: headers, libraries and scenes of this package."""
    return os.path.join(HERE, "prefix")


def program() -> str:
    """The path of the program delf that belongs to this module."""
    for folder in ([CHOSEN] if CHOSEN else []) + ["prefix", ""]:
        path = os.path.join(HERE, folder, "bin", "delf")
        if os.path.exists(path):
            return path
    raise SystemFailed("the program delf is not in this package; install it again")


def warn(line: str) -> None:
    warnings.warn(here(line), UserWarning, stacklevel=4)


def warn_of_other_commands(command: str, keys: Mapping[str, Any]) -> None:
    """Of keys that are given to a command which does not read them."""
    for line in _delf.keys_of_other_commands(command, list(texts_of(keys).items())):
        warnings.warn(line, UserWarning, stacklevel=3)


_FAILURES = {1: CheckFailed, 2: BadInput, 3: NumericsFailed, 4: SystemFailed}


def call(words: Sequence[str], fails: Sequence[int] = (1,)) -> "subprocess.CompletedProcess[str]":
    """Runs the program; its warnings become Python's, and its errors exceptions, but for exit codes in `fails`."""
    process = subprocess.Popen([program(), *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               stdin=subprocess.DEVNULL)
    try:
        out, err = process.communicate()
    except KeyboardInterrupt:
        process.send_signal(signal.SIGINT)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.communicate(timeout=5)
        process.kill()
        raise
    lines = [line for line in err.splitlines() if line]
    if process.returncode in (0, *fails):
        for line in lines:
            if not re.match(r"\d+ %: ", line):
                warn(line)
        return subprocess.CompletedProcess(process.args, process.returncode, out, err)
    if process.returncode in (130, -signal.SIGINT):
        raise KeyboardInterrupt
    message = next((line for line in reversed(lines) if not line.startswith(" ")), "the program ended without a word")
    message = message[6:] if message.startswith("delf: ") else message
    failure = _FAILURES.get(process.returncode, SystemFailed)(message)
    failure.text = out
    raise failure


@contextlib.contextmanager
def folder_for(out: Optional[Union[str, "os.PathLike[str]"]]) -> Iterator[str]:
    """`out`, or a folder that is removed at the end."""
    if out is not None:
        yield os.fspath(out)
        return
    scratch = tempfile.mkdtemp(prefix="delf-")
    try:
        yield os.path.join(scratch, "out")
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


@contextlib.contextmanager
def words_of(scene: Scene) -> Iterator[List[str]]:
    """The scene as words of a command line; keys without a file become one for as long."""
    if scene.file:
        yield [scene.file, *scene.program_words()]
        return
    scratch = tempfile.mkdtemp(prefix="delf-")
    try:
        path = os.path.join(scratch, "scene.ini")
        with open(path, "w", encoding="utf-8") as file:
            file.write(scene.text())
        yield [path]
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def _number(text: str) -> Any:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def structured(rows: Sequence[Mapping[str, Any]]) -> "np.ndarray[Any, Any]":
    """A structured array of rows that are dictionaries; numbers as float64, the rest as text."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    columns = []
    for name in names:
        values = [row.get(name) for row in rows]
        values = [float("nan") if value is None or value == "" else value for value in values]
        if all(isinstance(value, (bool, np.bool_)) for value in values):
            columns.append(np.array(values, dtype=bool))
        elif all(isinstance(value, (int, float)) for value in values):
            columns.append(np.array(values, dtype=float))
        else:
            columns.append(np.array(["" if value != value else str(value) for value in values], dtype=str))
    if not names:
        return np.zeros(0, dtype=[("none", float)])
    table = np.zeros(len(rows), dtype=[(name, column.dtype) for name, column in zip(names, columns)])
    for name, column in zip(names, columns):
        table[name] = column
    return table


def read_csv(path: str) -> "np.ndarray[Any, Any]":
    with open(path, newline="", encoding="utf-8") as file:
        return structured([{name: _number(text) for name, text in row.items()} for row in csv.DictReader(file)])


class Table:
    """The result of a command.

    table: a structured array, a line for each row; data: all of the command's JSON file; text: as the program prints it;
    passed: False if a check failed (exit code 1); frame: the table as a pandas DataFrame.
    """

    def __init__(self, command: str, table: "np.ndarray[Any, Any]", data: Dict[str, Any], text: str,
                 passed: bool) -> None:
        self.command, self.table, self.data, self.text, self.passed = command, table, data, text, passed

    @property
    def frame(self) -> Any:
        try:
            import pandas
        except ImportError:
            raise BadInput("frame: pandas is not installed; use table, a structured array") from None
        return pandas.DataFrame(self.table)

    def __getitem__(self, column: str) -> "np.ndarray[Any, Any]":
        names = self.table.dtype.names or ()
        if column not in names:
            import difflib
            near = difflib.get_close_matches(column, names, 1)
            raise BadInput(f"{column}: no such column" + (f"; did you mean {near[0]}?" if near else ""))
        return self.table[column]

    def __len__(self) -> int:
        return len(self.table)

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        names = ", ".join(self.table.dtype.names or ())
        return f"{self.command}: {len(self.table)} rows{'' if self.passed else ', not passed'}\n  {names}"

    def _repr_html_(self) -> str:
        import html
        return f"<pre>{html.escape(self.text)}</pre>"


def _command(name: str, scene: SceneLike, keys: Mapping[str, Any], out: Any, rows: Any, words: Sequence[str] = ()) -> Table:
    subject = scene_of(scene, keys)
    with folder_for(out) as folder, words_of(subject) as named:
        figures = [] if out is not None or "output.figures" in subject else ["--output.figures=off"]
        done = call([name, *named, *words, *figures, "--out", folder])
        with open(os.path.join(folder, f"{name}.json"), encoding="utf-8") as file:
            data = json.load(file)
        return Table(name, rows(folder, data), data, _without_folder(done.stdout, folder, out), done.returncode == 0)


def _without_folder(text: str, folder: str, out: Any) -> str:
    return text if out is not None else "".join(l for l in text.splitlines(True) if folder not in l)


def convergence(scene: SceneLike = None, *, out: Any = None, **keys: Any) -> Table:
    """Errors and orders at halved steps: columns sites, space_step, time_step, error_linf, error_l2, order, seconds."""
    return _command("convergence", scene, keys, out, lambda f, d: read_csv(os.path.join(f, "convergence.csv")))


def workprecision(scene: SceneLike = None, *, out: Any = None, **keys: Any) -> Table:
    """Error against run time of many schemes."""
    return _command("workprecision", scene, keys, out, lambda f, d: read_csv(os.path.join(f, "workprecision.csv")))


def stability(scene: SceneLike = None, *, out: Any = None, **keys: Any) -> Table:
    """Limits of the step by theory and by runs; maps, stress cases and dispersion are in `data`."""

    def limits(folder: str, data: Dict[str, Any]) -> "np.ndarray[Any, Any]":
        return structured([{name: value for name, value in one.items() if not isinstance(value, (list, dict))}
                           for one in data["limits"]])
    return _command("stability", scene, keys, out, limits)


def sweep(scene: SceneLike = None, *, out: Any = None, jobs: Any = None, **keys: Any) -> Table:
    """A scene for many values: keys that are given a list, a NumPy array or "from:to:step". A row for each run."""
    many: Dict[str, str] = {}
    if jobs is not None:
        many["sweep.jobs"] = str(jobs)
    once: Dict[str, Any] = {}
    for name, value in keys.items():
        if isinstance(value, np.ndarray):
            value = value.tolist()
        if isinstance(value, (list, tuple)) or (isinstance(value, str) and re.fullmatch(r"[^:]+:[^:]+:[^:]+", value)):
            many.update(texts_of({name: value}))
        else:
            once[name] = value
    subject = scene_of(scene, once)
    with folder_for(out) as folder, words_of(subject) as named:
        table = [] if out is not None or "sweep_keep" in keys else ["--sweep.keep=table"]
        if "sweep.bisect" not in subject and all(name.startswith("sweep.") for name in many):
            raise BadInput("sweep: give a key several values, as sites=[101, 201] or sites=\"101:401:100\"")
        passed = True
        try:
            text = call(["sweep", *named, *(f"--{k}={v}" for k, v in many.items()), *table, "--out", folder]).stdout
        except (BadInput, NumericsFailed, SystemFailed) as failure:
            if not re.match(r"\d+ of \d+ runs did not end well", str(failure)):
                raise
            text, passed = failure.text, False
            warn(str(failure).replace("the table above says", "the column status says"))
        with open(os.path.join(folder, "sweep.json"), encoding="utf-8") as file:
            data = json.load(file)
        rows = read_csv(os.path.join(folder, "sweep.csv"))
        return Table("sweep", rows, data, _without_folder(text, folder, out), passed)


class Plan:
    """What a run would solve, how, and at what cost: `text` as `delf plan` prints it, and its lines by their names."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.lines: Dict[str, str] = {}
        name = ""
        for line in text.splitlines()[1:]:
            match = re.match(r"^ {0,2}([a-z][a-z ]*?) {2,}(\S.*)$", line)
            if match:
                name = match[1]
                self.lines[name] = self.lines.get(name, "") + ("\n" if name in self.lines else "") + match[2]
            elif name and line.startswith("    "):
                self.lines[name] += "\n" + line.strip()

    @property
    def table(self) -> "np.ndarray[Any, Any]":
        return structured([{"name": name, "value": value} for name, value in self.lines.items()])

    def __getitem__(self, name: str) -> str:
        if name not in self.lines:
            raise BadInput(f"{name}: no such line of this plan; there are {', '.join(self.lines)}")
        return self.lines[name]

    def __str__(self) -> str:
        return self.text

    __repr__ = __str__

    def _repr_html_(self) -> str:
        import html
        return f"<pre>{html.escape(self.text)}</pre>"


def plan(scene: SceneLike = None, *, latex: Any = False, **keys: Any) -> Plan:
    """The plan of a scene; with latex=True its equations for a paper."""
    with words_of(scene_of(scene, keys)) as named:
        return Plan(call(["plan", *named, *(["--latex"] if latex else [])]).stdout)


class Verification(Table):
    """The result of delf.verify or delf.check.

    checks: a structured array (name, region, value, tolerance, passed, …); measured, diagnosis, severity: the same of
    what was measured, of what the rows do solve, and of the sites by |E| beside their force. print() gives the table of
    `delf verify`.
    """

    def __init__(self, text: str, data: Dict[str, Any], passed: bool) -> None:
        super().__init__("verify", structured(data["checks"]), data, text, passed)
        self.checks = self.table
        self.measured = structured(data["measured"])
        self.diagnosis = structured(data["diagnosis"])
        self.severity = structured(data["severity"])
        self.left_out: List[str] = list(data["left_out"])

    def __bool__(self) -> bool:
        return self.passed

    def __repr__(self) -> str:
        failed = [c["name"] for c in self.data["checks"] if not c["passed"]]
        words = [d["words"] for d in self.data["diagnosis"]]
        return "\n".join([f"verify: {len(self.checks)} checks, " + ("all passed" if self.passed else
                                                                     f"failed: {', '.join(failed)}"), *("  " + w for w in words)])


def verify(scene: SceneLike = None, *, fields: Any = None, nearby: Any = (), out: Any = None,
           raises: Any = False, **keys: Any) -> Verification:
    """Checks the rows of a scene, or those of `fields`, a file. raises=True: CheckFailed where a check fails."""
    subject = scene_of(scene, keys)
    rows = None if fields is None else os.fspath(fields)
    others = [os.fspath(file) for file in nearby]
    settings = subject.settings()
    if out is None and not settings.on_mesh:
        warn_of_other_commands("verify", keys)
        result = _verified(settings, subject.name, rows, others)
    else:
        words = [] if rows is None else ["--fields", rows]
        for other in others:
            words += ["--nearby", other]
        with folder_for(out) as folder, words_of(subject) as named:
            figures = [] if out is not None or "output.figures" in subject else ["--output.figures=off"]
            done = call(["verify", *named, *words, *figures, "--out", folder])
            with open(os.path.join(folder, "verify.json"), encoding="utf-8") as file:
                data = json.load(file)
        result = Verification(_without_folder(done.stdout, folder, out), data, done.returncode == 0)
    if raises and not result:
        raise _failed(result)
    return result


def _verified(settings: "_delf.Settings", name: str, rows: Optional[str], others: Sequence[str]) -> Verification:
    """In this process, without files."""
    main = threading.current_thread() is threading.main_thread()
    done = _delf.verify(settings, name, rows, others, main)
    for line in done["warnings"]:
        warn(line)
    if done["status"] == "interrupted":
        raise KeyboardInterrupt
    if done["failure"] is not None:
        failure: Error = done["failure"]
        raise failure
    return Verification(done["report"], json.loads(done["json"]), done["passed"])


def _failed(result: Verification) -> CheckFailed:
    failure = CheckFailed(repr(result))
    failure.run = result
    return failure


def check(rows: Any, *, density: Any = None, stencil: str = "rectangle-symmetric", h: float, length: Optional[float] = None,
          q: Any = None, p: Any = None, space: Optional[str] = None, raises: bool = False, scene: SceneLike = None,
          **keys: Any) -> Verification:
    """Checks rows of any program: an array rows × sites (× fields), a row for each time step of length h.

    density: the Lagrangian as text or a sympy expression (or theory=…, a name, or a scene); length: of the circle, or of
    the interval (space="interval"). q, p: positions and momenta of a point instead, steps × coordinates; rows is None.
    """
    given: Dict[str, Any] = {"stencil": stencil, "h": h}
    if density is not None:
        given["density"] = density
    momenta = None
    if rows is None:
        if q is None or p is None:
            raise BadInput("check: give rows, or q and p")
        array, momenta = np.asarray(q, dtype=float), np.asarray(p, dtype=float)
        given.pop("stencil") if stencil == "rectangle-symmetric" else None
        given["space"] = space or "point"
    else:
        array = np.asarray(rows, dtype=float)
        if array.ndim not in (2, 3):
            raise BadInput(f"check: rows has {array.ndim} axes; give rows × sites, or rows × sites × fields")
        given["space"] = space or "circle"
        if p is not None:
            momenta = np.asarray(p, dtype=float)
        if given["space"] != "point":
            given["sites"] = array.shape[1]
            if length is None and scene is None:
                raise BadInput("check: length: give the length of the circle or of the interval", "lattice.length")
            if length is not None:
                given["length"] = length
    given.update(keys)
    scratch = tempfile.mkdtemp(prefix="delf-")
    try:
        path = os.path.join(scratch, "rows.npy" if momenta is None else "rows.npz")
        if momenta is None:
            np.save(path, array)
        else:
            np.savez(path, q=array, p=momenta)
        try:
            result = verify(scene, fields=path, **given)
        except BadInput as error:  # in the words of this call
            raise BadInput(str(error).replace(f"fields {path}", "check: rows"), error.key or "") from None
        result.text = result.text.replace(path, "an array")
        result.data["subject"] = "rows of an array"
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    if raises and not result:
        raise _failed(result)
    return result
