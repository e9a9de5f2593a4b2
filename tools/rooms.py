#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the folders of the four rooms and which folder includes which. From the top folder:

    tools/rooms.py > tools/images/rooms.svg        needs dot (Debian: graphviz)
    rsvg-convert -o /tmp/rooms.png tools/images/rooms.svg        to look at it (Debian: librsvg2-bin)

An arrow from A to B: files in A include files in B. An arrow that follows from others (A → B → C gives A → C) is left
out. An include that closes a cycle is drawn dashed, in red.
"""
import collections
import pathlib
import re
import subprocess
import sys

# Rooms from top to bottom, each with the fill of its folders and the colour of its arrows.
ROOMS = {"tools": ("#e4efe4", "#4f8a4f"), "schemes": ("#fbe9dc", "#b3541e"),
         "jets": ("#ece4f4", "#7a4fa3"), "lattice": ("#dcecf2", "#1f6f8b")}


def read_folders():
    """Files and lines of each folder with sources, and how many includes lead from one folder to another."""
    files, lines, includes = collections.Counter(), collections.Counter(), collections.Counter()
    for room in ROOMS:
        for path in pathlib.Path(room).rglob("*"):
            if path.suffix not in (".hpp", ".cpp"):
                continue
            text, folder = path.read_text(encoding="utf-8"), str(path.parent)
            files[folder] += 1
            lines[folder] += text.count("\n")
            for other in re.findall(r'^#include "([^"]+)"', text, re.MULTILINE):
                target = str(pathlib.PurePosixPath(other).parent)
                if target != folder and target.split("/")[0] in ROOMS:
                    includes[folder, target] += 1
    return files, lines, includes


def reaches(arrows, start, end):
    """Is there a path of arrows from start to end?

    >>> reaches({"a": {"b"}, "b": {"c"}}, "a", "c"), reaches({"a": {"b"}}, "b", "a")
    (True, False)
    """
    seen, waiting = set(), [start]
    while waiting:
        folder = waiting.pop()
        if folder == end:
            return True
        if folder not in seen:
            seen.add(folder)
            waiting += arrows.get(folder, ())
    return False


def drawn_arrows(includes):
    """The arrows to draw: those that others do not imply; and those that close a cycle, fewest includes first.

    >>> drawn_arrows({("a", "b"): 3, ("b", "c"): 2, ("a", "c"): 5, ("c", "a"): 1})
    ([('a', 'b'), ('b', 'c')], [('c', 'a')])
    """
    arrows, back = {}, []
    for a, b in sorted(includes, key=lambda pair: (-includes[pair], pair)):
        if reaches(arrows, b, a):
            back.append((a, b))
        else:
            arrows.setdefault(a, set()).add(b)
    forward = [(a, b) for a in arrows for b in arrows[a]
               if not any(reaches(arrows, c, b) for c in arrows[a] if c != b)]
    return sorted(forward), sorted(back)


def label(folder, files, lines):
    name = folder.split("/", 1)[-1] + ("/" if "/" in folder else "")
    size = f"{files[folder]} files, {lines[folder]:,} lines".replace(",", " ")
    if "/" not in folder:
        name = "main and commands" if folder == "tools" else f"{folder} itself"
    return f'<<b>{name}</b><br/><font point-size="9" color="#555555">{size}</font>>'


def graph(files, lines, includes):
    """The picture in the language of dot."""
    forward, back = drawn_arrows(includes)
    text = ['digraph rooms {', 'graph [ranksep=0.32, nodesep=0.12, fontname="Helvetica", newrank=true, margin=0]',
            'node [shape=box, style="filled,rounded", fontname="Helvetica", fontsize=12, margin="0.08,0.04", height=0.3, '
            'color="#888888"]',
            'edge [arrowsize=0.6]']
    for room, (fill, _) in ROOMS.items():
        text.append(f'subgraph cluster_{room} {{ label="{room}/"; labeljust=l; fontsize=17; color="#bbbbbb"; '
                    f'bgcolor="#fcfcfc"; style=rounded; margin=7')
        text += [f'"{folder}" [label={label(folder, files, lines)}, fillcolor="{fill}"]'
                 for folder in sorted(files) if folder.split("/")[0] == room]
        text.append('}')
    for a, b in forward:
        text.append(f'"{a}" -> "{b}" [color="{ROOMS[a.split("/")[0]][1]}"]')
    for a, b in back:
        text.append(f'"{a}" -> "{b}" [color="#d02020", style=dashed, constraint=false]')
    return "\n".join(text + ['}'])


if __name__ == "__main__":
    picture = subprocess.run(["dot", "-Tsvg"], input=graph(*read_folders()), capture_output=True, text=True)
    if picture.returncode != 0:
        sys.exit(picture.stderr)
    print(picture.stdout, end="")
