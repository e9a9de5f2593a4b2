# SPDX-License-Identifier: MIT
"""The builds of this package: a wheel has one for any processor of its kind, and a folder for each level beyond.

All of them give the same bits. Python takes the highest level that the processor has; the environment variable DELF_CPU
names another one.
"""
from __future__ import annotations

import os
from typing import Dict, List, Set

BASELINE = "x86-64"
# The instructions that a level needs, as /proc/cpuinfo names them.
LEVELS: Dict[str, Set[str]] = {
    "x86-64-v3": {"cx16", "lahf_lm", "popcnt", "pni", "ssse3", "sse4_1", "sse4_2", "avx", "avx2", "bmi1", "bmi2", "f16c",
                  "fma", "abm", "movbe", "xsave"},
}


def flags() -> Set[str]:
    """The instructions of this processor; none where they are not known."""
    try:
        with open("/proc/cpuinfo", encoding="ascii", errors="replace") as file:
            return next((set(line.split()) for line in file if line.startswith("flags")), set())
    except OSError:
        return set()


def level(there: List[str], wanted: str) -> str:
    """Which of the levels that there are to take, or "" for the build for any processor."""
    lacking = {name: sorted(LEVELS[name] - flags()) for name in there}
    if not wanted:
        return next((name for name in reversed(there) if not lacking[name]), "")
    if not there:
        raise ImportError(f"DELF_CPU = {wanted}: this package has one build only; leave DELF_CPU out")
    if wanted not in (BASELINE, *there):
        raise ImportError(f"DELF_CPU = {wanted}: this package has no such build; take {' or '.join((BASELINE, *there))}")
    if lacking.get(wanted):
        raise ImportError(f"DELF_CPU = {wanted}: this processor lacks {', '.join(lacking[wanted])}; take {BASELINE}, or "
                          "leave DELF_CPU out")
    return "" if wanted == BASELINE else wanted


HERE = os.path.dirname(os.path.abspath(__file__))
BUILT = [name for name in LEVELS if os.path.isdir(os.path.join(HERE, name))]
CHOSEN = level(BUILT, os.environ.get("DELF_CPU", ""))
