# SPDX-License-Identifier: MIT
"""delf: discrete Euler–Lagrange field equations, from Python.

A run. Scenes are those of delf.scenes(), files, or keys alone; the result is in memory:

    run = delf.run("collision", until=20, **{"lattice.sites": 401})
    run.series["energy"]          a structured array: step, time, energy, energy_error, momentum, charge, …
    run.fields.field              frames × sites × fields; run.fields.phi: frames × sites; run.fields.time, .space
    run.summary.energy_error_max, run.plan, run.verify(), run.figures(), run.resume(until=40)

A theory of one's own, as text or a sympy expression, as a scene or stepped by hand:

    delf.run(density="0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1", stencil="hexagon", space="circle", sites=200, length=40,
             courant=0.5, initial_phi="4*atan(exp(x - 10)) - 4*atan(exp(x - 30))", until=20)
    evolution = delf.Scheme("0.5*phi_t^2 - …", "hexagon").on(delf.circle(200, 40), 0.1).start(lambda x: np.sin(…))
    evolution.step(100); evolution.row(), evolution.energy

Rows of any program, an array rows × sites:

    print(delf.check(rows, density="0.5*phi_t^2 - …", stencil="triangle-vertex", h=0.1, length=40))

Keys are those of the program: delf.help("run") prints them, and delf.help("lagrangians") the grammar of densities. The key
lattice.sites is given as lattice_sites=…, as **{"lattice.sites": …}, as scene["lattice.sites"], or scene.lattice.sites; those
of nearly every scene have short names too: density, constraint, symmetry, parameters, fields, theory, stencil, space, sites,
length, h, courant, method, state, until, steps, every. Lengths and times are dimensionless, as in the scenes.

A wheel has builds for several processors, of the same bits; DELF_CPU=x86-64 in the environment takes the one for any.

Errors are delf.BadInput, NumericsFailed, CheckFailed and SystemFailed, with key, file and line.
"""
import os as _os

_here = _os.path.dirname(_os.path.abspath(__file__))
_scenes = _os.path.join(_here, "prefix", "share", "delf", "scenes")
if _os.path.isdir(_scenes) and "DELF_SCENES" not in _os.environ:
    _os.environ["DELF_SCENES"] = _scenes

from ._processor import CHOSEN as _level
if _level:
    __path__.insert(0, _os.path.join(_here, _level))  # its _delf comes first

try:
    import numpy as _numpy
    from . import _delf as _delf
except ImportError as _error:
    import sys as _sys
    _python = f"{_sys.executable} (Python {_sys.version_info[0]}.{_sys.version_info[1]})"
    raise ImportError(f"delf: {_error}, for {_python}; take the interpreter that has NumPy and that delf was built for, "
                      "such as /usr/bin/python3") from None
from ._errors import BadInput, CheckFailed, Error, NumericsFailed, SystemFailed
from . import _program
from ._program import (Plan, Table, Verification, check, convergence, plan, prefix, program, stability, sweep, verify,
                       workprecision)
from ._run import Fields, Record, Run, Summary, load, run
from ._scene import Scene
from ._stepping import Evolution, Lattice, Scheme, circle, interval, point

__version__: str = _delf.version


def scenes() -> "list[str]":
    """The names of the shipped scenes."""
    return [name for name, _, _ in _delf.scenes()]


def keys() -> "list[dict[str, object]]":
    """Every key of a scene, as `delf help run` lists them: name, type, default, meaning, unit, choices."""
    return _delf.keys()


def help(topic: str = "") -> None:
    """Prints what `delf help TOPIC` prints: a command, such as run or verify, or lagrangians."""
    print(_program.call(["help", *([topic] if topic else [])]).stdout, end="")


__all__ = ["BadInput", "CheckFailed", "Error", "Evolution", "Fields", "Lattice", "NumericsFailed", "Plan", "Record", "Run",
           "Scene", "Scheme", "Summary", "SystemFailed", "Table", "Verification", "check", "circle", "convergence",
           "help", "interval", "keys", "load", "plan", "point", "prefix", "program", "run", "scenes", "stability", "sweep",
           "verify", "workprecision"]
