# SPDX-License-Identifier: MIT
"""A program that uses the package as its documentation shows, for a type checker alone."""
import numpy as np

import delf

run = delf.run("collision", **{"lattice.sites": 401}, until=20, at_record=lambda record: record.row > 3)
energy: float = run.summary.energy_final
longer: delf.Run = run.resume(until=40)
scene = delf.Scene("collision", **{"lattice.sites": 401})
scene["lattice.sites"] = 101
scene.theory.mass = 2.0
table = delf.sweep(scene, sites=[101, 201], jobs=1)
errors = delf.convergence("kink")["error_linf"].max()
evolution = delf.Scheme("0.5*phi_t^2 - 0.5*phi_x^2", "hexagon").on(delf.circle(200, 40), 0.1).start(np.sin)
evolution.step(100)
row: "np.ndarray[tuple[int, ...], np.dtype[np.float64]]" = evolution.row()
checks = delf.check(np.zeros((9, 9)), density="0.5*phi_t^2 - 0.5*phi_x^2", h=0.1, length=1.0)
if not checks.passed:
    print(checks.diagnosis["words"], checks)
try:
    delf.verify("collision", raises=True)
except delf.CheckFailed as failure:
    key: "str | None" = failure.key
