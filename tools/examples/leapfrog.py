#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A program that knows nothing of delf: it solves sine-Gordon, and writes the rows in a layout that delf can verify.

    phi_tt - phi_xx + sin phi = 0   on a circle of length 40,   a breather that beats at omega = 0.6

    leapfrog.py symplectic  DIR     phi_{j+1} = 2 phi_j - phi_{j-1} + h^2 (D^2 phi_j - sin phi_j)
    leapfrog.py runge-kutta DIR     the classical method of order four, for phi and phi_t

Each writes fields.h5, the solution, and nearby-a.h5, nearby-b.h5, which begin a little beside it, in two directions.
Their differences from it are first variations, up to their size: nearby-a2.h5 and nearby-b2.h5 begin half as far away,
in the same directions, so that one can see what is left as the size goes to zero.
"""
import pathlib
import sys

import h5py
import numpy as np

length, sites, rows, omega, size = 40.0, 64, 200, 0.6, 1e-5
k = length / sites  # space step
h = k / 2  # time step
x = k * np.arange(sites)


def breather(t):
    eta = np.sqrt(1 - omega**2)
    return 4 * np.arctan(eta / omega * np.cos(omega * t) / np.cosh(eta * (x - length / 2)))


def aside(direction, t):
    """Which way a nearby solution begins: a wave that runs to the right (a), or a pulse that runs to the left (b)."""
    return np.cos(2 * np.pi * (x - t) / length) if direction == "a" else np.exp(-((x + t - length / 2) ** 2) / 8)


def acceleration(phi):
    """phi_tt = D^2 phi - sin phi; np.roll goes around the circle."""
    return (np.roll(phi, -1) - 2 * phi + np.roll(phi, 1)) / k**2 - np.sin(phi)


def symplectic(start):
    phi = [start(0), start(h)]
    while len(phi) < rows:
        phi.append(2 * phi[-1] - phi[-2] + h**2 * acceleration(phi[-1]))
    return phi


def runge_kutta(start):
    slope = lambda state: np.array([state[1], acceleration(state[0])])
    state = np.array([start(0), (start(h) - start(-h)) / (2 * h)])  # phi and phi_t
    phi = [state[0]]
    while len(phi) < rows:
        s1 = slope(state)
        s2 = slope(state + h / 2 * s1)
        s3 = slope(state + h / 2 * s2)
        s4 = slope(state + h * s3)
        state = state + h / 6 * (s1 + 2 * s2 + 2 * s3 + s4)
        phi.append(state[0])
    return phi


def write(path, phi):
    with h5py.File(path, "w") as file:
        file["time"] = h * np.arange(rows)  # frames
        file["space"] = x  # sites
        file["field"] = np.array(phi).reshape(rows, sites, 1)  # frames x sites x fields
        for dataset in file.values():
            dataset.attrs["units"] = "dimensionless"


methods = {"symplectic": symplectic, "runge-kutta": runge_kutta}
if len(sys.argv) != 3 or sys.argv[1] not in methods:
    sys.exit("usage: leapfrog.py symplectic|runge-kutta DIR")
solve, folder = methods[sys.argv[1]], pathlib.Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)
write(folder / "fields.h5", solve(breather))
for direction in "ab":
    write(folder / f"nearby-{direction}.h5", solve(lambda t: breather(t) + size * aside(direction, t)))
    write(folder / f"nearby-{direction}2.h5", solve(lambda t: breather(t) + size / 2 * aside(direction, t)))
