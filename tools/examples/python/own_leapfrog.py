# SPDX-License-Identifier: MIT
# %% [markdown]
# # Checking one's own leapfrog
# A program of ten lines that knows nothing of delf, and what delf finds out about its rows.
# %%
import delf
import numpy as np

N, L, h = 128, 40.0, 0.1
k = L / N
x = k * np.arange(N)


def leapfrog(steps, force=np.sin):
    u = [4 * np.arctan(1 / np.cosh(x - L / 2)), 4 * np.arctan(1 / np.cosh(x - L / 2))]
    for _ in range(steps):
        u.append(2 * u[-1] - u[-2] + h**2 * ((np.roll(u[-1], 1) - 2 * u[-1] + np.roll(u[-1], -1)) / k**2 - force(u[-1])))
    return np.array(u)


density = "0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1"
# %% [markdown]
# Leapfrog is the discrete field equation of the stencil `triangle-vertex`: all checks pass.
# %%
good = delf.check(leapfrog(200), density=density, stencil="triangle-vertex", h=h, length=L)
print(good)
# %% [markdown]
# Sine without its quadrature at the right place, a wrong step, an edited value: what the rows do solve.
# %%
wrong = delf.check(leapfrog(200, lambda u: 1.1 * np.sin(u)), density=density, stencil="triangle-vertex", h=h, length=L)
wrong
# %%
rows = leapfrog(200)
rows[100, 40] += 1e-3
edited = delf.check(rows, density=density, stencil="triangle-vertex", h=h, length=L)
edited.severity
