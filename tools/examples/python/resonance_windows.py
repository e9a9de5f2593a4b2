# SPDX-License-Identifier: MIT
# %% [markdown]
# # Resonance windows of φ⁴
# A kink and an antikink meet. Above a critical speed they part; below it most pairs are caught, but for windows of speeds.
# %%
import delf
import numpy as np

speeds = np.round(np.linspace(0.18, 0.28, 21), 4)
table = delf.sweep("phi4-collision", initial_speed=speeds)
table
# %% [markdown]
# How often the pulses meet, and how fast they part in the end, over the speed.
# %%
import io

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
from IPython.display import SVG

figure, (above, below) = plt.subplots(2, 1, figsize=(7, 4), sharex=True)
above.plot(table["initial.speed"], table["bounces"], "o-")
above.set_ylabel("bounces")
below.plot(table["initial.speed"], table["outgoing"], "o-")
below.set_ylabel("outgoing speed")
below.set_xlabel("initial speed")
picture = io.StringIO()
figure.savefig(picture, format="svg")
SVG(picture.getvalue())
