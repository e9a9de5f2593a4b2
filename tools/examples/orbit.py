#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A program that knows nothing of delf: Kepler's problem in (q, p), one step after the other.

    q_tt + q/|q|^3 = 0   in the plane, h = 0.1, from q = (0.7, 0), p = (0, 1.2)

    orbit.py gauss DIR     Gauss's method of two stages, by fixed points
    orbit.py verlet DIR    drift-kick-drift Stoermer-Verlet
    orbit.py wrong DIR     kick-drift-kick, where the second kick takes the old q by mistake

Each writes orbit.npz with the arrays t, q and p, and a.npz, b.npz, which begin a little beside it, in two directions.
"""
import pathlib
import sys

import numpy as np

h, steps = 0.1, 200


def force(q):
    return -q / np.linalg.norm(q) ** 3


def gauss(q, p):
    r = np.sqrt(3) / 6
    a = np.array([[0.25, 0.25 - r], [0.25 + r, 0.25]])
    Q, P = np.array([q, q]), np.array([p, p])
    for _ in range(60):
        F = np.array([force(one) for one in Q])
        Q, P = q + h * a @ P, p + h * a @ F
    return q + h / 2 * P.sum(axis=0), p + h / 2 * np.array([force(one) for one in Q]).sum(axis=0)


def verlet(q, p):
    q = q + h / 2 * p
    p = p + h * force(q)
    return q + h / 2 * p, p


def wrong(q, p):
    p = p + h / 2 * force(q)
    return q + h * p, p + h / 2 * force(q)


def solve(method, q, p):
    rows = [(q, p)]
    for _ in range(steps):
        rows.append(method(*rows[-1]))
    return np.array([q for q, p in rows]), np.array([p for q, p in rows])


methods = {"gauss": gauss, "verlet": verlet, "wrong": wrong}
if len(sys.argv) != 3 or sys.argv[1] not in methods:
    sys.exit("usage: orbit.py gauss|verlet|wrong DIR")
folder = pathlib.Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)
for name, dq, dp in (("orbit", (0, 0), (0, 0)), ("a", (1e-6, 3e-7), (5e-7, 0)), ("b", (0, 1e-6), (-1e-6, 5e-7))):
    q, p = solve(methods[sys.argv[1]], np.array([0.7, 0.0]) + dq, np.array([0.0, 1.2]) + dp)
    np.savez(folder / f"{name}.npz", t=h * np.arange(steps + 1), q=q, p=p)
