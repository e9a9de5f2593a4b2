# SPDX-License-Identifier: MIT
"""delf: discrete Euler–Lagrange field equations, from Python.

    run = delf.run("collision", until=20)           a shipped scene; run.series, run.fields.field, run.summary
    delf.Scheme("0.5*phi_t^2 - …", "hexagon").on(delf.circle(N, L), h)   stepping by hand
    delf.check(rows, density=…, h=…, length=…)      rows of another program

Lengths and times are dimensionless, as in the scenes.
"""
import os as _os

_here = _os.path.dirname(_os.path.abspath(__file__))
_scenes = _os.path.join(_here, "prefix", "share", "delf", "scenes")
if _os.path.isdir(_scenes) and "DELF_SCENES" not in _os.environ:
    _os.environ["DELF_SCENES"] = _scenes

from . import _delf
from ._errors import BadInput, CheckFailed, Error, NumericsFailed, SystemFailed
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


__all__ = ["BadInput", "CheckFailed", "Error", "Evolution", "Fields", "Lattice", "NumericsFailed", "Plan", "Record", "Run",
           "Scene", "Scheme", "Summary", "SystemFailed", "Table", "Verification", "check", "circle", "convergence",
           "interval", "keys", "load", "plan", "point", "prefix", "program", "run", "scenes", "stability", "sweep",
           "verify", "workprecision"]
