# SPDX-License-Identifier: MIT
"""python3 -m delf test: some thirty quick checks of an installed package."""
from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import threading
import warnings
from typing import Any, Callable, List

import numpy as np

import delf

PHI_FOUR = "0.5*phi_t^2 - 0.5*phi_x^2 - 0.25*(phi^2 - 1)^2"
CHECKS: List[Callable[[], Any]] = []


def holds(function: Callable[[], Any]) -> Callable[[], Any]:
    CHECKS.append(function)
    return function


def raises(kind: Any, call: Callable[[], Any]) -> Any:
    try:
        call()
    except kind as error:
        return error
    raise AssertionError(f"{kind.__name__} was not raised")


def pair(sites: int = 100) -> Any:
    evolution = delf.Scheme(PHI_FOUR, "hexagon").on(delf.circle(sites, 40.0), 0.1)
    return evolution.start(lambda x: np.tanh((x - 10) / 2**0.5) - np.tanh((x - 30) / 2**0.5) - 1)


def leapfrog(steps: int = 60, N: int = 64, L: float = 40.0, h: float = 0.1) -> Any:
    k = L / N
    x = k * np.arange(N)
    u = [np.sin(2 * np.pi * x / L), np.sin(2 * np.pi * (x - h) / L)]
    for _ in range(steps):
        u.append(2 * u[-1] - u[-2] + h * h * ((np.roll(u[-1], 1) - 2 * u[-1] + np.roll(u[-1], -1)) / k**2 - np.sin(u[-1])))
    return np.array(u), h, L


@holds
def the_module_has_the_programs_version() -> None:
    out = subprocess.run([delf.program(), "--version"], capture_output=True, text=True, check=True).stdout
    assert out.strip() == f"delf {delf.__version__}"


@holds
def scenes_are_there() -> None:
    assert "collision" in delf.scenes() and len(delf.scenes()) > 20


@holds
def keys_are_there() -> None:
    assert {"lattice.sites", "theory.mass", "initial.speed"} <= {str(k["name"]) for k in delf.keys()}


@holds
def a_run_is_done() -> None:
    run = delf.run("collision", until=5)
    assert run.status == run.summary.status == "done" and run.folder is None


@holds
def series_have_columns() -> None:
    series = delf.run("collision", until=5).series
    assert series["time"][-1] > 4.9 and np.abs(series["energy_error"]).max() < 1e-3


@holds
def fields_have_shapes() -> None:
    run = delf.run("collision", until=5, **{"lattice.sites": 101})
    assert run.fields.field.shape == (len(run.series), 101, 1) and run.fields.space.shape == (101,)
    assert np.array_equal(run.fields.phi, run.fields.field[..., 0])
    assert not run.fields.field.flags.writeable


@holds
def rows_are_the_programs() -> None:
    run = delf.run("kink", until=2)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([delf.program(), "run", "kink", "--run.until=2", "--output.figures=off", "--out", folder],
                       check=True, capture_output=True)
        loaded = delf.load(folder)
        assert np.array_equal(run.series["energy"], loaded.series["energy"])
        try:
            assert np.array_equal(run.fields.field.ravel(), loaded.fields.field.ravel())
        except delf.BadInput:
            pass  # without h5py


@holds
def a_scene_is_a_mapping() -> None:
    scene = delf.Scene("collision")
    scene["lattice.sites"] = 101
    scene.theory.mass = 2.0
    assert scene["lattice.sites"] == scene.lattice.sites == 101 and scene["theory.mass"] == 2


@holds
def a_scene_needs_no_file() -> None:
    scene = delf.Scene(density=PHI_FOUR, stencil="triangle", space="circle", sites=64, length=20, courant=0.5, until=1,
                       initial_phi="cos(2*pi*x/20)")
    assert delf.run(scene).status == "done"


@holds
def an_unknown_key_suggests() -> None:
    error = raises(delf.BadInput, lambda: delf.Scene("collision", **{"lattice.site": 3}))
    assert str(error) == "lattice.site: unknown key; did you mean lattice.sites?" and error.key == "lattice.site"


@holds
def an_unknown_attribute_suggests() -> None:
    assert "mass" in str(raises(AttributeError, lambda: delf.Scene("collision").theory.mas))
    run = delf.run("kink", until=1)
    assert "energy_final" in str(raises(AttributeError, lambda: run.summary.energy_finl))
    assert 'series["energy"]' in str(raises(AttributeError, lambda: run.energy))
    assert "did you mean summary?" in str(raises(AttributeError, lambda: run.summry))
    assert 'scene["lattice.sites"]' in str(raises(AttributeError, lambda: setattr(delf.Scene("kink"), "sites", 5)))
    assert "phi" in str(raises(AttributeError, lambda: run.fields.ph))


@holds
def bad_input_has_its_place() -> None:
    error = raises(delf.BadInput, lambda: delf.run("collision", sites=1))
    assert error.key == "lattice.sites" and isinstance(error, ValueError)


@holds
def a_bad_line_has_its_number() -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "mine.ini")
        with open(path, "w") as file:
            file.write("[lattice]\nsites = 3x\n[run]\nsteps = 1\n")
        error = raises(delf.BadInput, lambda: delf.run(path))
        assert error.file == path and error.line == 2 and error.key == "lattice.sites", vars(error)


@holds
def failed_numerics_keep_rows() -> None:
    blow_up: Any = dict(density="0.5*phi_t^2 - 0.5*phi_x^2 + phi^4", space="circle", sites=32, length=10, courant=0.5,
                   stencil="triangle-vertex", initial_phi="2", until=20)
    error = raises(delf.NumericsFailed, lambda: delf.run(None, **blow_up))
    assert len(error.run.series) >= 1


@holds
def records_are_seen() -> None:
    seen = []
    delf.run("collision", until=3, at_record=lambda record: seen.append(record.field))
    assert len(seen) > 5 and not seen[0].flags.writeable and np.isfinite(seen[0]).all()


@holds
def a_callback_stops() -> None:
    run = delf.run("collision", until=1000, at_record=lambda record: record.row > 100)
    assert run.status == "stopped" and run.summary.time < 100


@holds
def a_callback_may_raise() -> None:
    raises(ZeroDivisionError, lambda: delf.run("kink", until=3, at_record=lambda record: 1 / 0))


@holds
def warnings_are_pythons() -> None:
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        delf.run("collision", until=1, **{"theory.lambda": 2})
    assert any("theory.lambda" in str(w.message) for w in seen), seen


@holds
def two_threads_run() -> None:
    done: List[Any] = [None, None]
    def work(i: int) -> None:
        done[i] = delf.run("collision", until=5 + i)
    threads = [threading.Thread(target=work, args=(i,)) for i in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [r.status for r in done] == ["done", "done"]
    assert np.array_equal(done[0].series["energy"], delf.run("collision", until=5).series["energy"])


@holds
def stepping_by_hand() -> None:
    evolution = pair()
    evolution.step(99)
    assert evolution.newest == 100 and evolution.residual < 1e-13 and abs(evolution.time - 10) < 1e-12


@holds
def rows_stay_what_they_are() -> None:
    evolution = pair()
    first = evolution.row()
    values = first.copy()
    assert evolution.row() is not None and np.shares_memory(first, evolution.row())
    evolution.step(1000)
    del evolution
    assert np.array_equal(first, values) and not first.flags.writeable


@holds
def the_energy_stays() -> None:
    evolution = pair(200)
    before = evolution.energy
    evolution.step(500)
    assert abs(evolution.energy / before - 1) < 1e-2


@holds
def a_step_needs_a_start() -> None:
    raises(delf.BadInput, delf.Scheme(PHI_FOUR).on(delf.circle(20, 10.0), 0.1).step)


@holds
def two_rows_start_too() -> None:
    a = pair()
    b = delf.Scheme(PHI_FOUR, "hexagon").on(delf.circle(100, 40.0), 0.1).start_rows(a.row(1), a.row(0))
    a.step(10)
    b.step(10)
    assert np.allclose(a.row(), b.row(), atol=1e-12)


@holds
def constraints_are_kept() -> None:
    evolution = delf.Scheme("0.5*(u_t^2 + v_t^2) - 0.5*(u_x^2 + v_x^2)", "rectangle", fields="u, v",
                            constraint="u^2 + v^2 - 1").on(delf.circle(41, 2 * np.pi), 0.05)
    evolution.start_rows(*(lambda x, t=t: (np.cos(np.sin(x - t)), np.sin(np.sin(x - t))) for t in (0, 0.05)))
    evolution.step(50)
    assert np.abs((evolution.row() ** 2).sum(axis=1) - 1).max() < 1e-12


@holds
def a_sympy_density_is_text() -> None:
    try:
        import sympy
    except ImportError:
        return
    t, x, u = sympy.symbols("phi_t phi_x phi")
    evolution = delf.Scheme(t**2 / 2 - x**2 / 2 - (u**2 - 1) ** 2 / 4, "hexagon").on(delf.circle(100, 40.0), 0.1)
    reference = pair()
    evolution.start(reference.row(1), 0)
    evolution.step(5)
    reference.step(5)
    assert np.allclose(evolution.row(), reference.row(), atol=1e-6)


@holds
def a_plan_has_lines() -> None:
    plan = delf.plan("collision")
    assert "cost" in plan.lines and "state" in plan.lines and "collision" in str(plan)


@holds
def a_scene_verifies() -> None:
    result = delf.verify("collision", until=2)
    assert result.passed and len(result.checks) > 3 and "form formula" in str(result).replace("-", " ").lower()


@holds
def ones_own_leapfrog_is_checked() -> None:
    rows, h, L = leapfrog()
    density = "0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1"
    good = delf.check(rows, density=density, stencil="triangle-vertex", h=h, length=L)
    assert good.passed, str(good)
    rows[30, 20] += 1e-3
    bad = delf.check(rows, density=density, stencil="triangle-vertex", h=h, length=L)
    assert not bad.passed and len(bad.severity) > 0
    raises(delf.CheckFailed, lambda: delf.check(rows, density=density, stencil="triangle-vertex", h=h, length=L,
                                                raises=True))


@holds
def positions_and_momenta_are_checked() -> None:
    h, q, p = 0.1, [1.0], [0.0]
    for _ in range(80):
        half = p[-1] - h / 2 * np.sin(q[-1])
        q.append(q[-1] + h * half)
        p.append(half - h / 2 * np.sin(q[-1]))
    result = delf.check(None, q=np.array(q)[:, None], p=np.array(p)[:, None], density="0.5*phi_t^2 + cos(phi)",
                        stencil="vertex", h=h)
    assert len(result.checks) > 0


@holds
def convergence_has_orders() -> None:
    table = delf.convergence("kink", convergence_levels=3, until=2)
    assert len(table) == 3 and table["error_linf"][0] > table["error_linf"][1]


@holds
def a_sweep_has_rows() -> None:
    table = delf.sweep("kink", until=1, sites=[101, 201])
    assert len(table) == 2 and "lattice.sites" in table.table.dtype.names


@holds
def a_mesh_runs() -> None:
    run = delf.run("sphere", steps=2)
    assert run.status == "done" and run.folder is None


@holds
def things_print() -> None:
    scene = delf.Scene("collision", sites=101)
    assert "lattice" in repr(scene) and "<pre>" in scene._repr_html_() and "done" in repr(delf.run("kink", until=1))


def main() -> int:
    warnings.simplefilter("ignore")
    failed = 0
    for check in CHECKS:
        try:
            check()
        except Exception as error:  # noqa: BLE001: every check is tried
            failed += 1
            import traceback
            where = traceback.extract_tb(error.__traceback__)[-1]
            print(f"FAILED {check.__name__}: {type(error).__name__}: {error} (line {where.lineno})")
    print(f"delf {delf.__version__}: {len(CHECKS) - failed} of {len(CHECKS)} checks passed")
    return 1 if failed else 0
