# SPDX-License-Identifier: MIT
"""The module of the build tree, beyond what `python3 -m delf test` checks of an installed one (those checks run too)."""
import io
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time
import warnings

import numpy as np
import pytest

import delf
from delf import _delf, _selftest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("check", _selftest.CHECKS, ids=lambda check: check.__name__)
def test_of_installed_package(check):
    check()


@pytest.mark.parametrize("scene", ["collision", "kink", "breather", "phi4-kink", "interval", "coupled-sine-gordon",
                                   "wave-map", "toda-chain", "pendulum", "beam"])
def test_rows_are_those_of_the_program_to_the_bit(scene, tmp_path):
    h5py = pytest.importorskip("h5py")
    run = delf.run(scene, steps=60, every=1, output_figures=False)
    subprocess.run([delf.program(), "run", scene, "--run.steps=60", "--output.every=1", "--output.figures=off", "--out",
                    tmp_path], check=True, capture_output=True)
    loaded = delf.load(tmp_path)
    for name in run.fields:
        assert np.array_equal(run.fields[name].ravel(), loaded.fields[name].ravel(), equal_nan=True), name
    for name in run.series.dtype.names:
        assert np.array_equal(run.series[name], loaded.series[name], equal_nan=True), name
    ours, theirs = dict(run.summary), dict(loaded.summary)
    for timing in ("seconds", "ns_per_site_step"):
        ours.pop(timing), theirs.pop(timing)
    assert ours == theirs
    assert run.text == (tmp_path / "scene.ini").read_text()


def test_korteweg_de_vries_by_hand_steps_as_the_scene_does_gauge_included():
    density = "0.5*phi_x*phi_t + phi_x^3/6 - 0.5*phi_xx^2"
    by_hand = delf.Scheme(density, "six-tuple").on(delf.circle(33, 2 * np.pi), 0.01)
    assert "no equation determines the mean of a row" in by_hand.plan
    by_hand.start(lambda x: 0.5 + np.sin(x))  # linear in phi_t: row 0 alone
    by_hand.step(50 - by_hand.newest)
    run = delf.run(density=density, stencil="six-tuple", space="circle", sites=33, length="2*pi", h=0.01,
                   initial_phi="0.5 + sin(x)", steps=50)
    assert np.abs(by_hand.row() - np.asarray(run.fields["field"])[-1].ravel()).max() < 1e-12
    assert abs(by_hand.row().mean() - 0.5) < 1e-13
    assert abs(by_hand.energy - run.series["energy"][-1]) < 1e-10


def test_every_key_of_help_run_is_reachable():
    text = subprocess.run([delf.program(), "help", "run"], check=True, capture_output=True, text=True).stdout
    listed, section = set(), ""
    for line in text.splitlines():
        if match := re.match(r"^\s*\[([a-z]+)\]", line):
            section = match[1]
        elif match := re.match(r"^\s{1,4}([a-z]+\.[a-z_]\w*)\b", line):
            listed.add(match[1])
        elif section and (match := re.match(r"^\s{1,4}([a-z_]\w*)\s{2,}", line)):
            listed.add(f"{section}.{match[1]}")
    assert len(listed) > 60
    known = {key["name"] for key in delf.keys()}
    assert listed <= known, listed - known
    scene = delf.Scene("collision")
    for key in listed:
        scene[key]  # a value or None; an unknown key raises


def test_an_interrupt_ends_a_run_within_a_second_and_keeps_its_rows():
    program = """
import delf, sys, time
print("begun", flush=True)
try:
    delf.run("collision", until=1e7, at_record=lambda r: None)
except KeyboardInterrupt as interrupted:
    print(len(interrupted.run.series) > 1, interrupted.run.status)
"""
    child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    child.stdout.readline()
    time.sleep(1.5)
    began = time.monotonic()
    child.send_signal(signal.SIGINT)
    out, _ = child.communicate(timeout=20)
    assert out.split() == ["True", "interrupted"]
    print(f"{time.monotonic() - began:.2f} s from the signal to the end of the process")


def test_the_lock_is_released_while_stepping():
    evolution = _selftest.pair(2000)
    counted = [0]
    over = threading.Event()

    def count():
        while not over.is_set():
            counted[0] += 1
    thread = threading.Thread(target=count)
    thread.start()
    evolution.step(5000)
    over.set()
    thread.join()
    assert counted[0] > 1000


def test_threads_may_share_an_evolution():
    evolution = _selftest.pair()
    rows = []

    def work():
        for _ in range(200):
            evolution.step()
            rows.append(evolution.row())
    threads = [threading.Thread(target=work) for _ in range(4)]
    [t.start() for t in threads], [t.join() for t in threads]
    assert evolution.newest == 801 and all(np.isfinite(row).all() for row in rows)


def test_a_row_outlives_its_evolution_by_a_million_steps():
    evolution = _selftest.pair(20)
    row = evolution.row()
    values = row.tolist()
    evolution.step(1_000_000)
    del evolution
    assert row.tolist() == values


def test_a_failing_run_can_be_shown_failing(tmp_path):
    with pytest.raises(delf.BadInput):
        delf.load(tmp_path)
    with pytest.raises(delf.BadInput):
        delf.check(np.zeros(3), density="0.5*phi_t^2", h=1, length=1)
    with pytest.raises(delf.BadInput):
        _selftest.pair().row(7)
    with pytest.raises(delf.BadInput):
        delf.Scheme("0.5*phi_t^2 -").on(delf.circle(20, 1.0), 0.1)


def test_a_folder_is_gone_on_with(tmp_path):
    run = delf.run("kink", out=tmp_path / "a", until=2, output_figures=False)
    longer = run.resume(until=4)
    straight = delf.run("kink", until=4)
    assert longer.folder and np.array_equal(longer.series["energy"][-1], straight.series["energy"][-1])
    assert np.array_equal(delf.run("kink", until=2).resume(until=4).series["energy"], straight.series["energy"])


@pytest.mark.parametrize("scene, first, whole", [
    ("collision", dict(until=20.05, every=7), dict(until=50)), ("kink", dict(until=2), dict(until=4)),
    ("wave-map", dict(steps=25, every=10), dict(steps=60)), ("pendulum", dict(steps=25, every=10), dict(steps=60)),
    ("phi6-moving-mesh", dict(steps=25, every=10), dict(steps=60))])
def test_a_run_in_memory_goes_on_to_the_same_bits(scene, first, whole):
    begun = delf.run(scene, **first)
    longer = begun.resume(**whole)
    straight = delf.run(scene, **{"every": begun.scene["output.every"] or every_of(begun), **first, **whole})
    assert len(begun.series) < len(longer.series) == len(straight.series)
    for name in straight.series.dtype.names:
        assert np.array_equal(longer.series[name], straight.series[name], equal_nan=True), name
    for name in straight.fields:
        assert np.array_equal(longer.fields[name], straight.fields[name], equal_nan=True), name
    ours, theirs = dict(longer.summary), dict(straight.summary)
    for timing in ("seconds", "ns_per_site_step"):
        ours.pop(timing), theirs.pop(timing)
    assert ours == theirs and longer.text == straight.text


def every_of(run):
    return int(re.search(r"^every = (\d+)$", run.text, re.M)[1])


def test_a_run_that_was_stopped_goes_on():
    stopped = delf.run("collision", until=20, every=7, at_record=lambda record: record.row > 100)
    straight = delf.run("collision", until=20, every=7)
    assert stopped.status == "stopped" and stopped.resume(until=20).status == "done"
    assert np.array_equal(stopped.resume(until=20).fields.field, straight.fields.field)
    with pytest.raises(delf.BadInput, match="run.until"):
        straight.resume(until=3)


def test_a_mesh_in_memory_goes_on_to_the_same_bits():
    pytest.importorskip("h5py")
    begun, straight = delf.run("sphere", steps=5, every=1), delf.run("sphere", steps=12, every=1)
    longer = begun.resume(steps=12)
    assert len(begun.series) == 6 and len(longer.series) == len(straight.series) == 13 and longer.folder is None
    fields = longer.fields
    del longer
    for name in straight.fields:
        assert np.array_equal(fields[name], straight.fields[name], equal_nan=True), name


def test_a_sweep_keeps_its_table_where_a_run_fails():
    unstable = dict(density="0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1", stencil="triangle-vertex", space="circle", sites=100,
                    length=10, initial_phi="exp(-(x - 5)^2)", until=40)
    with pytest.warns(UserWarning, match="^1 of 2 runs did not end well: the column status says why$"):
        table = delf.sweep(courant=[0.5, 1.7], **unstable)
    assert not table.passed and list(table["status"]) == ["done", "not-finite"]
    with pytest.raises(delf.BadInput, match="several values, as sites="):
        delf.sweep("kink", until=1, sweep_jobs=2)


def test_rows_start_alike_from_arrays_and_functions():
    lattice, start = delf.circle(200, 40.0), lambda x: np.tanh((x - 10) / 2**0.5) - np.tanh((x - 30) / 2**0.5) - 1
    rows = [delf.Scheme(_selftest.PHI_FOUR, "hexagon").on(lattice, 0.1).start(*given).row()
            for given in ((start, 0), (start(lattice.x), np.zeros(200)), (start, lambda x: 0 * x))]
    assert all(np.array_equal(row, rows[0]) for row in rows)


def test_a_single_field_has_its_name_in_a_folder_too(tmp_path):
    pytest.importorskip("h5py")
    assert delf.run("kink", until=1, out=tmp_path / "a", output_figures=False).fields.phi.ndim == 2


def test_keys_that_another_command_reads_are_warned_of():
    with pytest.warns(UserWarning, match="^verify.variations = 3: warning: only `delf verify` reads it$"):
        delf.run("kink", until=1, **{"verify.variations": 3})
    with pytest.warns(UserWarning, match="^sweep.jobs = 2: warning: only `delf sweep` or `delf compare` reads it$"):
        delf.verify("kink", until=1, sweep_jobs=2)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        delf.verify("kink", until=1, verify_variations=3)


def test_the_highest_build_that_the_processor_can_take_is_chosen(monkeypatch):
    from delf import _processor
    built = list(_processor.LEVELS)
    monkeypatch.setattr(_processor, "flags", lambda: _processor.LEVELS["x86-64-v3"] | {"fpu"})
    assert _processor.level(built, "") == _processor.level(built, "x86-64-v3") == "x86-64-v3"
    assert _processor.level(built, "x86-64") == _processor.level([], "") == ""
    with pytest.raises(ImportError, match="^DELF_CPU = avx: this package has no such build; take x86-64 or x86-64-v3$"):
        _processor.level(built, "avx")
    with pytest.raises(ImportError, match="one build only"):
        _processor.level([], "x86-64")
    monkeypatch.setattr(_processor, "flags", lambda: _processor.LEVELS["x86-64-v3"] - {"avx2"})
    assert _processor.level(built, "") == ""
    with pytest.raises(ImportError, match="lacks avx2; take x86-64"):
        _processor.level(built, "x86-64-v3")


@pytest.mark.parametrize("scene, keys", [
    ("collision", dict(until=3)), ("kink", dict(until=3)), ("wave-map", dict(steps=30)), ("pendulum", dict(steps=100)),
    ("spherical-pendulum", dict(steps=30)), ("kink", {"until": 3, "scheme.method": "vu-quoc-li"})])
def test_verify_finds_what_the_program_finds(scene, keys, tmp_path):
    here = delf.verify(scene, **keys)
    there = delf.verify(scene, out=tmp_path / "made", output_figures=False, **keys)
    ours, theirs = dict(here.data), dict(there.data)
    ours.pop("seconds"), theirs.pop("seconds")
    assert ours == theirs and here.passed == there.passed == ("scheme.method" not in keys)
    untimed = lambda result: re.sub(r"stencils in .*? s", "", str(result))
    assert untimed(here) == untimed(there).split(str(tmp_path))[0]


def test_rows_that_do_not_fit_are_refused_in_the_words_of_the_call():
    with pytest.raises(delf.BadInput, match="^check: rows: .*lattice.sites"):
        delf.check(np.zeros((10, 3)), density="0.5*phi_t^2 - 0.5*phi_x^2", h=0.1, length=1, sites=7)


def test_memory_of_a_row_is_used_again_only_if_nobody_views_it():
    evolution = _selftest.pair(50)
    kept, copies = [], []
    for n in range(60):
        evolution.step()
        row = evolution.row(n % 2)
        view = row[3:9] if n % 3 == 0 else memoryview(row) if n % 3 == 1 else row.reshape(5, 10).T
        if n % 4 == 0:
            kept.append(view), copies.append(np.array(view))
        with pytest.raises(ValueError):
            row[0] = 1
        with pytest.raises(ValueError):
            row.flags.writeable = True
        del row, view
    for view, copy in zip(kept, copies):
        assert np.array_equal(np.array(view), copy)
    addresses = set()
    for _ in range(20):
        evolution.step()
        addresses.add(evolution.row().ctypes.data)
    assert len(addresses) <= 3


def test_tables_are_frames_where_pandas_is():
    pytest.importorskip("pandas")
    table = delf.convergence("kink", until=1, convergence_levels=2)
    assert list(table.frame.columns) == list(table.table.dtype.names) and len(table.frame) == len(table) == 2


def test_symmetries_as_text_have_their_sums():
    evolution = delf.Scheme("0.5*(u_t^2 + v_t^2) - 0.5*(u_x^2 + v_x^2)", "rectangle", fields="u, v",
                            symmetry="-v, u").on(delf.circle(41, 2 * np.pi), 0.05)
    evolution.start(lambda x: (np.cos(x), np.sin(x)), lambda x: (np.sin(x), 0.3 * np.cos(x)))
    before = evolution.monitors["symmetry"]
    evolution.step(200)
    assert abs(before) > 0.1 and abs(evolution.monitors["symmetry"] - before) < 1e-11 * abs(before)


@pytest.mark.parametrize("with_tqdm", [True, False])
def test_progress_is_shown_in_terminals_alone(with_tqdm, monkeypatch):
    from delf import _run
    if with_tqdm:
        pytest.importorskip("tqdm")
    else:
        monkeypatch.setitem(sys.modules, "tqdm.auto", None)

    class Terminal(io.StringIO):
        def isatty(self):
            return True

    assert not _run._Progress.wanted()
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    assert _run._Progress.wanted()
    progress = _run._Progress(delf.Scene("collision", until=10))
    progress(delf.Record(1, 2.5, 0.0, np.zeros(1)))
    assert terminal.getvalue() == ""  # a run of a moment
    progress.began -= 9
    progress.shown -= 9
    progress(delf.Record(100, 2.5, 0.0, np.zeros(1)))
    progress.close()
    assert re.search(r"25 ?%", terminal.getvalue())


def test_no_memory_is_lost():
    def resident():
        return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE")
    scene = delf.Scene("collision", steps=10)
    for _ in range(200):
        delf.run(scene)
    before = resident()
    for _ in range(int(os.environ.get("DELF_LEAK_RUNS", "500"))):
        delf.run(scene)
    grown = resident() - before
    print(f"RSS grew by {grown} bytes over {os.environ.get('DELF_LEAK_RUNS', '500')} runs of 10 steps")
    assert grown < 8 << 20


def mypy(*words, **environment):
    pytest.importorskip("mypy")
    return subprocess.run([sys.executable, "-m", *words], capture_output=True, text=True,
                          env={**os.environ, "MYPYPATH": str(pathlib.Path(delf.__file__).parents[1]), **environment})


def test_types_are_those_of_the_package_and_its_examples(tmp_path):
    used = ROOT / "tests/python/typed_use.py"
    wrong = tmp_path / "wrong.py"
    wrong.write_text("import delf\ndelf.Scheme().on(delf.point(), 1).stepp(1)\n")
    files = [*pathlib.Path(delf.__file__).parent.glob("*.py*"), *(ROOT / "tools/examples/python").glob("*.py"), used, wrong]
    done = mypy("mypy", "--config-file", str(ROOT / "tests/python/mypy.ini"), "--cache-dir", str(tmp_path),
                *map(str, files))
    (error,) = [line for line in done.stdout.splitlines() if "error:" in line]
    assert '"Evolution" has no attribute "stepp"' in error


def test_stubs_name_all_that_the_module_has(tmp_path):
    allowed = tmp_path / "allowed"
    allowed.write_text("delf._delf.Evolution\ndelf._delf.Settings\n")  # their metaclass is the binding's
    done = mypy("mypy.stubtest", "delf._delf", "--allowlist", str(allowed))
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("name", ["first_steps", "own_leapfrog", "resonance_windows"])
def test_notebooks_run(name, tmp_path):
    for needed in ("nbclient", "ipykernel") + (("matplotlib",) if name == "resonance_windows" else ()):
        pytest.importorskip(needed)
    folder = ROOT / "tools/examples/python"
    done = subprocess.run([sys.executable, folder / "execute.py", folder / f"{name}.py", tmp_path / "made.ipynb"],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    made = json.loads((tmp_path / "made.ipynb").read_text())
    kept = json.loads((folder / f"{name}.ipynb").read_text())
    assert [cell["source"] for cell in made["cells"]] == [cell["source"] for cell in kept["cells"]]
    print(done.stdout)
