# SPDX-License-Identifier: MIT
"""Runs: in memory, or in a folder of the program."""
from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
import sys
import tempfile
import threading
import time
import weakref
from typing import Any, Callable, Dict, Iterator, List, Mapping, NamedTuple, Optional, Tuple, Union

import numpy as np

from . import _delf, _program
from ._errors import BadInput, Error, NumericsFailed
from ._scene import Scene, scene_of, text_of

SceneLike = Union[Scene, str, "os.PathLike[str]", None]
Arrays = Dict[str, "np.ndarray[Any, Any]"]
Components = Mapping[str, List[str]]  # names of the last axis of a dataset


class Record(NamedTuple):
    """What `at_record` is given: row number, time, energy, and the field, a read-only array sites × fields."""
    row: int
    time: float
    energy: float
    field: "np.ndarray[Any, Any]"


class Summary(Mapping[str, Any]):
    """summary.json as attributes and items."""

    def __init__(self, data: Dict[str, Any]) -> None:
        self._data = data

    def __getitem__(self, name: str) -> Any:
        return self._data[name]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self._data[name]
        except KeyError:
            import difflib
            near = difflib.get_close_matches(name, list(self._data), 1)
            raise AttributeError(f"no such number: {name}" + (f"; did you mean {near[0]}?" if near else "")) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)

    def __dir__(self) -> List[str]:
        return list(self._data)

    def __repr__(self) -> str:
        return "\n".join(f"{name:<20} {value}" for name, value in self._data.items() if not isinstance(value, (list, dict)))


class Fields(Mapping[str, Any]):
    """The recorded rows: time, space and field as arrays; further datasets, such as multiplier, as items.

    field: frames × sites × fields. Each field and multiplier by its own name is frames × sites: fields.phi. Of a folder the
    arrays are read when they are asked for.
    """

    def __init__(self, load: "Callable[[], Tuple[Arrays, Components]]") -> None:
        self._load = load
        self._loaded: "Optional[Tuple[Arrays, Components]]" = None

    def _both(self) -> "Tuple[Arrays, Components]":
        if self._loaded is None:
            self._loaded = self._load()
        return self._loaded

    def _all(self) -> "Arrays":
        return self._both()[0]

    def __getitem__(self, name: str) -> "np.ndarray[Any, Any]":
        arrays, components = self._both()
        if name not in arrays:
            for dataset, names in components.items():
                if name in names:
                    return arrays[dataset][..., names.index(name)]
        return arrays[name]

    def __getattr__(self, name: str) -> "np.ndarray[Any, Any]":
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError:
            arrays, components = self._both()
            known = [*arrays, *(one for names in components.values() for one in names)]
            raise AttributeError(f"no dataset {name}; there are {', '.join(known)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())

    def __repr__(self) -> str:
        return "\n".join(f"{name:<12} {' × '.join(map(str, array.shape))}" for name, array in self._all().items())


class Run:
    """A run with its results.

    scene, summary (attributes), series (a structured array: step, time, energy, …), fields (time, space, field), folder
    (None in memory), report (text), status; figures(), resume(until=…), verify(), plan.
    """

    def __init__(self, scene: Scene, summary: Dict[str, Any], series: "np.ndarray[Any, Any]", fields: Fields,
                 report: str = "", text: str = "", folder: Optional[str] = None, section: str = "",
                 state: bytes = b"") -> None:
        self.scene, self.summary, self.series, self.fields = scene, Summary(summary), series, fields
        self._made_of, self._state = scene.copy(), state
        self._scratch: Optional[_Scratch] = None  #: on a mesh: the folder of the program, without `folder`
        self.report, self.folder = report, folder
        self.text = text  #: scene.ini: the scene with all that was in force
        self.section = section  #: section.csv, if output.section asks for it

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("_"):
            import difflib
            places = {**{one: f"summary.{one}" for one in self.summary},
                      **{one: f'series["{one}"]' for one in self.series.dtype.names or ()},
                      **{one: one for one in (*vars(self), *dir(Run)) if not one.startswith("_")}}
            near = difflib.get_close_matches(name, list(places), 1)
            where = places[near[0]] if near else f"fields.{name}" if name in self.fields else ""
            raise AttributeError(f"a run has no {name}" + (f"; did you mean {where}?" if where else ""))
        raise AttributeError(name)

    @property
    def status(self) -> str:
        return str(self.summary["status"])

    @property
    def plan(self) -> "_program.Plan":
        return _program.plan(self.scene)

    def verify(self, **options: Any) -> "_program.Verification":
        """Checks the rows of this scene: see delf.verify."""
        return _program.verify(self.scene, **options)

    def figures(self, folder: Union[str, "os.PathLike[str]", None] = None, format: str = "svg") -> Dict[str, bytes]:
        """The figures of `delf run`, as files' contents by their names; with `folder` they are written there too.

        Of a run in memory the program draws them, from the same rows made again.
        """
        import glob
        with _program.folder_for(None) as scratch:
            source = self.folder
            if source is None or not glob.glob(os.path.join(source, "figures", "*." + format)):
                with _program.words_of(self.scene) as named:
                    _program.call(["run", *named, "--output.figures=on", f"--output.format={format}",
                                   "--output.fields=off", "--out", scratch])
                source = scratch
            found: Dict[str, bytes] = {}
            for path in sorted(glob.glob(os.path.join(source, "figures", "*." + format))):
                with open(path, "rb") as file:
                    found[os.path.splitext(os.path.basename(path))[0]] = file.read()
            if folder is not None:
                os.makedirs(folder, exist_ok=True)
                for name, data in found.items():
                    with open(os.path.join(os.fspath(folder), f"{name}.{format}"), "wb") as out:
                        out.write(data)
            return found

    def resume(self, until: Optional[float] = None, steps: Optional[int] = None, *,
               at_record: Optional[Callable[[Record], Any]] = None) -> "Run":
        """The run to a later time, from where it is, to the same bits as a run that goes there at once.

        A run in a folder goes on there, from its checkpoint; of a run in memory the result is a new one, with the records of
        both.
        """
        if (until is None) == (steps is None):
            raise BadInput("resume: give until or steps", "run.until")
        key, value = ("run.until", until) if until is not None else ("run.steps", steps)
        if self.folder is not None:
            return _by_program(self.folder, ["resume", self.folder, f"--{key}={text_of(value)}"])
        scene = self._made_of.copy()
        for other in ("run.until", "run.steps"):
            scene._given.pop(other, None)
        scene[key] = value
        if self._scratch:
            return _in_scratch(scene, lambda folder, named: ["resume", folder, f"--{key}={text_of(value)}"],
                               self._scratch)
        if every := re.search(r"^every = (\d+)$", self.text, re.M):
            scene["output.every"] = int(every[1])  # by default it follows from the end
        if not self._state:
            raise BadInput(f"resume: the run ended as {self.status}, and cannot go on; run the scene again")
        return _in_memory(scene, at_record, self)

    def _tree(self) -> str:
        s = self.summary
        lines = [f"Run {s['scene']}: {s['status']}",
                 f"  {s['theory']}, {s['stencil']}, N = {s['sites']}, {s['steps']} steps to t = {s['time']}",
                 f"  energy error {s['energy_error_max']}, residual {s['residual_max']}",
                 f"  series  {len(self.series)} records: {', '.join(self.series.dtype.names or ())}"]
        if self.folder:
            lines.append(f"  folder  {self.folder}")
        lines += [f"  warning {line}" for line in s["warnings"]]
        return "\n".join(lines)

    def __repr__(self) -> str:
        return self._tree()

    def _repr_html_(self) -> str:
        import html
        text = f"<pre>{html.escape(self._tree())}</pre>"
        try:
            figures = self.figures(format="svg")
        except Error:
            return text
        first: bytes = figures.get("spacetime", next(iter(figures.values()), b""))
        return text + first.decode("utf-8", "replace")


def _read_fields(path: str, only: str) -> "Tuple[Arrays, Components]":
    """The datasets of a fields.h5, and the names of their components; a single field is named `only`."""
    try:
        import h5py
    except ImportError:
        raise BadInput(f"{path}: reading it takes h5py; install python3-h5py, or run in memory") from None
    with h5py.File(path) as file:
        scales = {name for name in file if file[name].attrs.get("CLASS") == b"DIMENSION_SCALE"}
        arrays = {name: file[name][()] for name in ("time", "space", *sorted(set(file) - {"time", "space"} - scales))}
        names = {name: file[name].attrs.get("components", b"") for name in arrays}
        components = {name: text.decode().split(",") for name, text in names.items() if text}
        if arrays["field"].shape[-1] == 1:
            components.setdefault("field", [only])
        return arrays, components


def load(folder: Union[str, "os.PathLike[str]"]) -> Run:
    """The run of a folder that the program, or run(out=…), left."""
    folder = os.fspath(folder)
    try:
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        with open(os.path.join(folder, "scene.ini"), encoding="utf-8") as file:
            text = file.read()
    except OSError as error:
        raise BadInput(f"{folder}: is no folder of a run: {error.strerror}; name one with summary.json") from None
    scene = Scene(os.path.join(folder, "scene.ini"))
    return Run(scene, summary, _program.read_csv(os.path.join(folder, "series.csv")),
               Fields(lambda: _read_fields(os.path.join(folder, "fields.h5"), str(scene["theory.fields"]))), text=text,
               folder=folder)


def _in_notebook() -> bool:
    return "ipykernel" in sys.modules


class _Progress:
    """tqdm in terminals and notebooks, if it is installed; a plain line in a terminal without it; else nothing."""

    def __init__(self, scene: Scene) -> None:
        self.bar: Any = None
        self.began = self.shown = time.monotonic()
        self.end = scene["run.until"]
        self.steps = scene["run.steps"]
        self.line = False

    @staticmethod
    def wanted() -> bool:
        return _in_notebook() or (sys.stderr is not None and sys.stderr.isatty())

    def __call__(self, record: Record) -> None:
        now = time.monotonic()
        if now - self.began < 2 or now - self.shown < 0.2:
            return
        self.shown = now
        total, at = (self.end, record.time) if self.end else (self.steps, record.row)
        if not isinstance(total, (int, float)):
            return
        if self.bar is None and not self.line:
            try:
                from tqdm.auto import tqdm
                self.bar = tqdm(total=total, leave=False, unit="t" if self.end else "step")
            except ImportError:
                self.line = True
        if self.bar is not None:
            self.bar.n = round(min(at, total), 3)
            self.bar.refresh()
        else:
            print(f"\r{100 * at / total:3.0f} %  row {record.row}\033[K", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()
        elif self.line:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


def _series(done: Mapping[str, Any]) -> "np.ndarray[Any, Any]":
    names: List[str] = list(done["series_names"])
    whole = {"step": np.int64, "iterations": np.int64}
    series = np.zeros(len(done["series"]), dtype=[(name, whole.get(name, np.float64)) for name in names])
    for i, name in enumerate(names):
        series[name] = done["series"][:, i]
    return series


def _in_memory(scene: Scene, at_record: Optional[Callable[[Record], Any]], earlier: Optional[Run] = None) -> Run:
    progress = _Progress(scene) if _Progress.wanted() else None

    def see(*record: Any) -> bool:
        given = Record(*record)
        if progress:
            progress(given)
        return at_record is not None and at_record(given) is True

    main = threading.current_thread() is threading.main_thread()
    try:
        done = _delf.run(scene.settings(), scene.name, see if at_record or progress else None, main,
                         earlier._state if earlier else b"")
    finally:
        if progress:
            progress.close()
    summary = json.loads(done["summary"])
    if done["status"] == "stopped":
        summary["status"] = "stopped"
    series, rows = _series(done), done["rows"]
    if earlier:
        before = done["records_before"]
        series = np.concatenate([earlier.series[:before], series])
        rows = {name: np.concatenate([earlier.fields[name][:before], row]) for name, row in rows.items()}
    arrays = {"time": series["time"], "space": done["space"], **rows}
    for array in (series, *arrays.values()):
        array.flags.writeable = False
    result = Run(scene, summary, series, Fields(lambda: (arrays, done["components"])), done["report"], done["scene"], section=done["section"],
                 state=done["state"])
    for line in summary["warnings"]:
        _program.warn(line)
    if done["interrupted"] and main:
        error = KeyboardInterrupt("the run was interrupted; what it recorded is in the attribute run")
        error.run = result  # type: ignore[attr-defined]
        raise error
    if done["failure"] is not None:
        failure: Error = done["failure"]
        failure.run = result
        raise failure
    return result


def _by_program(folder: str, words: List[str]) -> Run:
    """A run of the program in a folder. What it recorded until it failed or was interrupted is `run` of the exception."""
    try:
        done = _program.call(words)
    except (KeyboardInterrupt, NumericsFailed) as error:
        with contextlib.suppress(Error):
            error.run = load(folder)  # type: ignore[union-attr]
        raise
    result = load(folder)
    result.report = done.stdout
    return result


class _Scratch:
    """A folder that is removed with this object, or at the end of Python."""

    def __init__(self) -> None:
        self.path = tempfile.mkdtemp(prefix="delf-")
        weakref.finalize(self, shutil.rmtree, self.path, True)


def _in_scratch(scene: Scene, words: Callable[[str, List[str]], List[str]], earlier: Optional[_Scratch] = None) -> Run:
    """The same in a folder that lives as long as the result; with `earlier`, the folder of another one, it goes on there."""
    scratch = _Scratch()
    folder = os.path.join(scratch.path, "run")
    if earlier:
        shutil.copytree(os.path.join(earlier.path, "run"), folder)

    def held(loaded: Run) -> Run:
        fields = Fields(lambda: (scratch, loaded.fields._both())[1])
        result = Run(scene, dict(loaded.summary), loaded.series, fields,
                     _program._without_folder(loaded.report, folder, None), loaded.text)
        result._scratch = scratch
        return result

    with _program.words_of(scene) as named:
        try:
            return held(_by_program(folder, words(folder, named)))
        except (KeyboardInterrupt, NumericsFailed) as error:
            if getattr(error, "run", None):
                error.run = held(error.run)  # type: ignore[union-attr]
            raise


def run(scene: SceneLike = None, *, out: Any = None, at_record: Any = None, **keys: Any) -> Run:
    """Steps a scene: a name, a file, a Scene, or keys alone; run("collision", **{"lattice.sites": 401}, until=20).

    In memory, unless `out` names a folder for all files of `delf run`. at_record: called with a Record at each recorded
    row; returning True ends the run. Ctrl-C raises KeyboardInterrupt, and its attribute `run` has the rows so far; so has
    that of NumericsFailed. Scenes on a mesh are run by the program, in a folder that is removed if `out` is not given.
    """
    subject = scene_of(scene, keys)
    if out is None and not subject.settings().on_mesh:
        _program.warn_of_other_commands("run", keys)
        return _in_memory(subject, at_record)
    if at_record is not None:
        raise BadInput("at_record: takes a run in memory, of a scene on a lattice; leave it or `out` away")
    if out is None:
        return _in_scratch(subject, lambda folder, named: [
            "run", *named, *([] if "output.figures" in subject else ["--output.figures=off"]), "--out", folder])
    with _program.words_of(subject) as named:
        return _by_program(os.fspath(out), ["run", *named, "--out", os.fspath(out)])
