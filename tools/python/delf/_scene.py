# SPDX-License-Identifier: MIT
"""Scenes: keys with values, from a file, a shipped scene or nothing."""
from __future__ import annotations

import os
from typing import Any, Dict, Iterator, List, Mapping, Optional, Tuple, Union

from . import _delf
from ._errors import BadInput

# Short names of keys that nearly every scene has.
SHORT: Dict[str, str] = {
    "density": "theory.density", "constraint": "theory.constraint", "symmetry": "theory.symmetry",
    "parameters": "theory.parameters", "fields": "theory.fields", "theory": "theory.name",
    "stencil": "lattice.stencil", "space": "lattice.space", "sites": "lattice.sites", "length": "lattice.length",
    "h": "lattice.time_step", "time_step": "lattice.time_step", "courant": "lattice.courant",
    "method": "scheme.method", "state": "initial.state", "until": "run.until", "steps": "run.steps",
    "every": "output.every",
}
SECTIONS: List[str] = sorted({key["name"].split(".")[0] for key in _delf.keys()})


def text_of(value: Any) -> str:
    """A value as a scene has it: True is on, a list is a,b,c, and a sympy expression its string with ^ for **."""
    if hasattr(value, "tolist"):  # NumPy's numbers and arrays
        value = value.tolist()
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, Mapping):
        return ", ".join(f"{name} = {text_of(one)}" for name, one in value.items())
    if isinstance(value, (list, tuple)):
        return ",".join(text_of(one) for one in value)
    return str(value).replace("**", "^")


def key_of(name: str) -> str:
    """The key that a Python name stands for: density, lattice_sites, "lattice.sites"."""
    if "." in name:
        return name
    if name in SHORT:
        return SHORT[name]
    section, _, rest = name.partition("_")
    return f"{section}.{rest}" if rest and section in SECTIONS else name


def texts_of(keys: Mapping[str, Any]) -> Dict[str, str]:
    return {key_of(name): text_of(value) for name, value in keys.items()}


class Section:
    """The keys of one section as attributes: scene.theory.mass."""

    def __init__(self, scene: "Scene", name: str) -> None:
        object.__setattr__(self, "_scene", scene)
        object.__setattr__(self, "_name", name)

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_"):
            raise AttributeError(key)
        try:
            return self._scene[f"{self._name}.{key}"]
        except BadInput as error:
            raise AttributeError(str(error)) from None

    def __setattr__(self, key: str, value: Any) -> None:
        try:
            self._scene[f"{self._name}.{key}"] = value
        except BadInput as error:
            raise AttributeError(str(error)) from None

    def __repr__(self) -> str:
        values = {key: getattr(self, key) for key in self.__dir__()}
        return f"Section {self._name}\n" + "\n".join(f"  {key:<16} {value}" for key, value in values.items()
                                                    if value is not None)

    def __dir__(self) -> List[str]:
        head = self._name + "."
        return [k["name"][len(head):] for k in self._scene.settings().keys() if k["name"].startswith(head)]


class Scene:
    """A scene: delf.Scene("collision"), delf.Scene("mine.ini"), or delf.Scene(density="0.5*phi_t^2 - …", sites=101, …).

    Keys are items ("lattice.sites"), attributes of their section (scene.lattice.sites), or keyword arguments. The values
    are checked when the scene is used, by the same table as the program's.
    """

    def __init__(self, name: Union[str, "os.PathLike[str]", None] = None, **keys: Any) -> None:
        self._file = "" if name is None else os.fspath(name)
        self._given: Dict[str, str] = {}
        if self._file:
            self._file = _delf.find_scene(self._file)
        self.update(keys)
        self.settings()

    @property
    def name(self) -> str:
        """Of its file, without the ending; "scene" of keys alone."""
        return os.path.splitext(os.path.basename(self._file))[0] if self._file else "scene"

    @property
    def file(self) -> Optional[str]:
        return self._file or None

    def settings(self) -> "_delf.Settings":
        return _delf.Settings(self._file, list(self._given.items()))

    def update(self, keys: Mapping[str, Any]) -> "Scene":
        new = texts_of(keys)
        if new:
            given = {**self._given, **new}
            _delf.Settings(self._file, list(given.items()))  # unknown keys raise here, with a suggestion
            self._given = given
        return self

    def with_(self, **keys: Any) -> "Scene":
        """A copy with other values."""
        other = self.copy()
        return other.update(keys)

    def copy(self) -> "Scene":
        other = object.__new__(Scene)
        other._file, other._given = self._file, dict(self._given)
        return other

    def check(self) -> List[str]:
        """Reads all values; raises BadInput, and returns the warnings of the scene."""
        return list(self.settings().check())

    def __getitem__(self, key: str) -> Any:
        """The text in force, as a number or a bool where it is one; None where nothing is."""
        text = self.settings().value(key_of(key))
        if text is None or text == "":
            return None
        if text in ("on", "off"):
            return text == "on"
        for kind in (int, float):
            try:
                return kind(text)
            except ValueError:
                pass
        return text

    def __setitem__(self, key: str, value: Any) -> None:
        self.update({key: value})

    def __delitem__(self, key: str) -> None:
        if key_of(key) not in self._given:
            raise BadInput(f"{key_of(key)}: is not given over the scene's file", key_of(key))
        del self._given[key_of(key)]

    def __contains__(self, key: str) -> bool:
        return key_of(key) in self.settings().given

    def __iter__(self) -> Iterator[str]:
        return iter(self.settings().given)

    def items(self) -> List[Tuple[str, str]]:
        """The keys that are given, with their texts."""
        return list(self.settings().given.items())

    def __getattr__(self, name: str) -> Section:
        if name in SECTIONS:
            return Section(self, name)
        import difflib
        near = difflib.get_close_matches(name, [*SECTIONS, *(n for n in dir(Scene) if not n.startswith("_"))], 1)
        meant = f'scene["{SHORT[name]}"]' if name in SHORT else near[0] if near else ""
        raise AttributeError(f"a scene has no section {name}" + (f"; did you mean {meant}?" if meant else ""))

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_"):  # scene.sites = 5 would be no key of the scene
            meant = key_of(name)
            raise AttributeError(f"a scene has no attribute {name}" + (f'; did you mean scene["{meant}"]?' if "." in meant
                                 else f'; give its keys, as scene["{name}.KEY"]' if name in SECTIONS else ""))
        object.__setattr__(self, name, value)

    def __dir__(self) -> List[str]:
        return list(super().__dir__()) + SECTIONS

    def text(self) -> str:
        """The scene as an INI file."""
        sections: Dict[str, List[str]] = {}
        for key, value in self.items():
            head, _, rest = key.partition(".")
            sections.setdefault(head, []).append(f"{rest} = {value}")
        return "\n\n".join(f"[{head}]\n" + "\n".join(lines) for head, lines in sections.items()) + "\n"

    def program_words(self) -> List[str]:
        """The keys over its file, as the program takes them."""
        return [f"--{key}={value}" for key, value in self._given.items()]

    def _tree(self) -> str:
        lines = [f"Scene {self.name}"]
        section = ""
        for key, value in sorted(self.items(), key=lambda item: (SECTIONS.index(item[0].split(".")[0]), 0)):
            head, _, rest = key.partition(".")
            if head != section:
                lines.append(f"  {head}")
                section = head
            mark = " *" if key in self._given and self._file else ""
            lines.append(f"    {rest:<16} {value}{mark}")
        return "\n".join(lines)

    __repr__ = _tree

    def _repr_html_(self) -> str:
        import html
        return f"<pre>{html.escape(self._tree())}</pre>"


def scene_of(scene: Union[Scene, str, "os.PathLike[str]", None], keys: Mapping[str, Any]) -> Scene:
    if isinstance(scene, Scene):
        return scene.copy().update(keys)
    return Scene(scene, **dict(keys))
