# SPDX-License-Identifier: MIT
# %% [markdown]
# # First steps
# A theory as text, two pulses that collide, their energy, and the form formula.
# %%
import delf
import numpy as np

scene = delf.Scene(
    density="0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1",
    stencil="rectangle-symmetric", space="circle", sites=201, length=40, courant=0.5,
    initial_phi="4*atan(exp(x - 10)) - 4*atan(exp(x - 30))", until=40)
scene
# %% [markdown]
# A run is in memory: a structured array of numbers, and the field, frames × sites × fields.
# %%
run = delf.run(scene)
print(run.fields)
print("largest energy error:", np.abs(run.series["energy_error"]).max())
run
# %% [markdown]
# How a step is solved, and what `delf verify` finds: the field equations at every site, and the form formula on regions of
# all kinds.
# %%
print(delf.plan(scene)["solve"] if "solve" in delf.plan(scene).lines else delf.plan(scene))
# %%
checks = delf.verify(scene, until=5)
print(checks)
# %% [markdown]
# Stepping by hand: rows are NumPy arrays.
# %%
evolution = delf.Scheme(scene["theory.density"], "hexagon").on(delf.circle(200, 40), 0.1)
evolution.start(lambda x: 4 * np.arctan(np.exp(x - 10)) - 4 * np.arctan(np.exp(x - 30)))
before = evolution.energy
evolution.step(1000)
print(evolution, "\nenergy error", evolution.energy / before - 1, "residual", evolution.residual)
