# SPDX-License-Identifier: MIT
"""Stepping by hand: Scheme(density, stencil).on(circle(N, L), h)."""
from __future__ import annotations

from typing import Any, Callable, Dict, List, Mapping, Sequence, Union

import numpy as np

from . import _delf
from ._errors import BadInput
from ._scene import Scene

Values = Union[Sequence[float], "np.ndarray[Any, Any]", float, Callable[..., Any]]


class Lattice:
    """Sites on a circle, an interval or a point: circle(N, L), interval(N, L), point()."""

    def __init__(self, space: str, sites: int = 1, length: float = 1.0, **walls: Any) -> None:
        self.space, self.sites, self.length, self.walls = space, sites, length, walls

    @property
    def cells(self) -> int:
        return self.sites - 1 if self.space == "interval" else self.sites

    @property
    def space_step(self) -> float:
        """k."""
        return self.length / self.cells

    @property
    def x(self) -> "np.ndarray[Any, Any]":
        """The positions of the sites, to the bit those of an evolution."""
        return np.arange(self.sites) * self.length / self.cells

    def keys(self) -> Dict[str, Any]:
        if self.space == "point":
            return {"lattice.space": "point"}
        return {"lattice.space": self.space, "lattice.sites": self.sites, "lattice.length": self.length,
                **{f"boundary.{side}": wall for side, wall in self.walls.items()}}

    def __repr__(self) -> str:
        return "point()" if self.space == "point" else f"{self.space}({self.sites}, {self.length})"


def circle(sites: int, length: float) -> Lattice:
    """N sites on a circle of length L."""
    return Lattice("circle", sites, length)


def interval(sites: int, length: float, left: str = "fixed", right: str = "fixed") -> Lattice:
    """N sites on an interval of length L, with walls that are fixed, natural or clamped."""
    return Lattice("interval", sites, length, left=left, right=right)


def point() -> Lattice:
    """A point: mechanics."""
    return Lattice("point")


class Scheme:
    """A density and a stencil; the equations are generated.

    density: text, a sympy expression, or the name of a theory with theory=…; constraint, symmetry, parameters and fields
    as a scene has them; further keys such as method="composition" or scheme_tolerance=1e-12.
    """

    def __init__(self, density: Any = None, stencil: Any = None, *, constraint: Any = None, symmetry: Any = None,
                 parameters: Any = None, fields: Any = None, **keys: Any) -> None:
        self._keys: Dict[str, Any] = dict(keys)
        named = {"density": density, "stencil": stencil, "constraint": constraint, "symmetry": symmetry,
                 "parameters": parameters, "fields": fields}
        self._keys.update({name: value for name, value in named.items() if value is not None})

    def on(self, lattice: Lattice, h: float, winding: int = 0, **keys: Any) -> "Evolution":
        """Ready to start on this lattice, with time steps h. winding: φ(x + L) = φ(x) + 2π winding."""
        scene = Scene()
        scene.update({**self._keys, **keys, **lattice.keys(), "lattice.time_step": float(h)})
        fields = [name for name in str(scene["theory.fields"] or "").replace(",", " ").split()]
        if scene["initial.state"] is None:
            names = fields or [k["name"][8:] for k in scene.settings().keys()
                               if k["name"].startswith("initial.") and k["name"][8:] == "phi"] or ["phi"]
            for name in names:
                scene[f"initial.{name}"] = 0.0
        if scene["run.steps"] is None:
            scene["run.steps"] = 0
        return Evolution(scene, lattice, winding)

    def __repr__(self) -> str:
        return "Scheme\n" + "\n".join(f"  {name:<12} {value}" for name, value in self._keys.items())


class Evolution:
    """A scheme on a lattice, with its rows.

    Rows are arrays of N values, or N × fields; x: positions of the sites. row(back) is read-only and stays what it is
    when steps go on: later steps make new ones. Calls from several threads wait for each other; the interpreter's lock is
    released in all of them.
    """

    def __init__(self, scene: Scene, lattice: Lattice, winding: int = 0) -> None:
        self.scene, self.lattice = scene, lattice
        self._engine = _delf.Evolution(scene.settings(), winding)
        self.step = self._engine.step  # type: ignore
        self.row = self._engine.row  # type: ignore

    def _values(self, of: Values) -> "np.ndarray[Any, Any]":
        if callable(of):
            of = of(self.x)
        array = np.asarray(of, dtype=np.float64)
        if array.ndim == 0:
            array = np.full(self.lattice.sites, float(array))
        if array.ndim == 2 and array.shape[0] != self.lattice.sites and array.shape[1] == self.lattice.sites:
            array = array.T  # a function of x that returned (u, v, …)
        return np.ascontiguousarray(array)

    def start(self, y0: Values, v0: Values = 0.0) -> "Evolution":
        """Row 0 and φ_t there, as arrays, numbers or functions of x; row 1 is solved for. With a constraint: start_rows.

        Of a density that is linear in φ_t, such as Korteweg–de Vries, row 0 alone determines row 1, and v0 is not read.
        """
        row, rate = self._values(y0), self._values(v0)
        if rate.shape != row.shape and np.ndim(v0 if not callable(v0) else 1) == 0:
            rate = np.full(row.shape, float(np.asarray(v0)))
        self._engine.start(row, rate)
        return self

    def start_rows(self, *rows: Values) -> "Evolution":
        """The first rows themselves, two for most schemes."""
        self._engine.start_rows([self._values(row) for row in rows])
        return self

    def step(self, count: int = 1) -> None:
        """So many steps. Ctrl-C ends them between two, with the rows whole."""

    def row(self, back: int = 0) -> "np.ndarray[Any, Any]":  # type: ignore[empty-body]
        """The newest row, or the one `back` rows before it."""

    def momenta(self, back: int = 0) -> "np.ndarray[Any, Any]":
        """The momenta at a row, N × components: half of the field equation there."""
        return self._engine.momenta(back)

    @property
    def x(self) -> "np.ndarray[Any, Any]":
        return self._engine.x

    @property
    def newest(self) -> int:
        """The number of the newest row; −1 before a start."""
        return self._engine.newest

    @property
    def time(self) -> float:
        return self._engine.time

    @property
    def monitors(self) -> Dict[str, float]:
        """Energy, momentum, charge, and what symmetries conserve, of the last two rows."""
        return self._engine.monitors()

    @property
    def energy(self) -> float:
        """k Σ (φ_t ∂ℓ/∂φ_t − ℓ) over the last two rows."""
        return self.monitors["energy"]

    @property
    def residual(self) -> float:
        """Of the last step's equations, relative to their terms."""
        return self._engine.residual

    @property
    def iterations(self) -> int:
        return self._engine.iterations

    @property
    def plan(self) -> str:
        """How a step is solved, as `delf plan` prints it."""
        return self._engine.plan

    def __repr__(self) -> str:
        return f"Evolution on {self.lattice}, h = {self._engine.time_step}\n  {self._engine.solve}\n  row {self.newest}"

    def _repr_html_(self) -> str:
        import html
        return f"<pre>{html.escape(repr(self))}</pre>"
