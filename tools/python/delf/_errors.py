# SPDX-License-Identifier: MIT
"""What delf raises: one line that says where, what and the remedy, with its place as attributes."""
from __future__ import annotations

import re
from typing import Any, Optional

_PLACE = re.compile(r"^(?P<file>[^\s:][^:\n]*?)(?::(?P<line>\d+))?: (?:--)?(?P<key>[a-z_]+\.[\w.]+)(?: = .*?)?: ", re.S)


def here(message: str) -> str:
    """The program's words without its command line: keys are given otherwise here."""
    return re.sub(r"^command line: (--)?", "", message)


class Error(Exception):
    """The base of everything that delf raises on purpose.

    key: the scene's key, such as "lattice.sites", or None; file, line: where it is given, or None.
    run: of a run that failed, what was recorded until then, or None.
    """

    def __init__(self, message: str = "", key: str = "") -> None:
        super().__init__(here(message))
        place = _PLACE.match(message)
        self.key: Optional[str] = key or (place["key"] if place else None) or None
        self.file: Optional[str] = place["file"] if place and place["file"] != "command line" else None
        self.line: Optional[int] = int(place["line"]) if place and place["line"] else None
        self.run: Any = None
        self.text = ""  #: of the program: what it printed before
        if self.key is None and (unknown := re.match(r"^(\w+): unknown key", here(message))):
            self.key = unknown[1]
        if self.file is None and (plain := re.match(r"^([^\s:]+\.ini)(?::(\d+))?: ", message)):
            self.file, self.line = plain[1], int(plain[2]) if plain[2] else None


class BadInput(Error, ValueError):
    """A scene, a key or an array that cannot be met: exit code 2 of the program."""


class NumericsFailed(Error, ArithmeticError):
    """No convergence, not finite, or a mesh that crosses itself: exit code 3. `run` has the rows before."""


class CheckFailed(Error, AssertionError):
    """A check failed: exit code 1. Raised where `raises=True` asks for it."""


class SystemFailed(Error, OSError):
    """Memory, disk, or a program that is missing: exit code 4."""
