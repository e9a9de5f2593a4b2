#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the rooms, their files and which includes which, from the top folder:

    tools/rooms.py > tools/images/rooms.svg
"""
import pathlib
import re

ROOMS = ["lattice", "jets", "schemes", "tools"]
LINE, TOP, WIDTH, GAP = 13, 70, 175, 95


def name_of(path):
    return str(path.with_suffix(""))


files, includes = {}, set()
for room in ROOMS:
    paths = sorted(p for p in pathlib.Path(room).rglob("*") if p.suffix in (".hpp", ".cpp"))
    files[room] = sorted({name_of(p) for p in paths})
    for path in paths:
        for other in re.findall(r'#include "([^"]+)"', path.read_text()):
            target = name_of(pathlib.Path(other))
            if target != name_of(path):
                includes.add((name_of(path), target))

place, edges = {}, []
for column, room in enumerate(ROOMS):
    for row, name in enumerate(files[room]):
        place[name] = (column, TOP + row * LINE)
height = max(y for _, y in place.values()) + 30
left = [20 + column * (WIDTH + GAP) for column in range(4)]

print(f'<svg xmlns="http://www.w3.org/2000/svg" width="{left[3] + WIDTH + 20}" height="{height}" font-family="sans-serif">')
print(f'<rect width="100%" height="100%" fill="white"/>')
colours = ["#1f6f8b", "#7a4fa3", "#b3541e"]
for a, b in sorted(includes):
    if a not in place or b not in place or place[a][0] == place[b][0]:
        continue
    (ca, ya), (cb, yb) = place[a], place[b]
    assert cb < ca, f"{a} includes {b}: against the arrows"
    x_1, x_2, bend = left[ca] - 4, left[cb] + WIDTH + 4, (left[ca] - left[cb] - WIDTH) / 2
    print(f'<path d="M{x_1},{ya - 4} C{x_1 - bend},{ya - 4} {x_2 + bend},{yb - 4} {x_2},{yb - 4}" fill="none" '
          f'stroke="{colours[cb]}" stroke-opacity="0.28"/>')
for column, room in enumerate(ROOMS):
    count = sum(1 for a, b in includes if a in place and b in place and place[a][0] == place[b][0] == column)
    print(f'<text x="{left[column]}" y="30" font-size="20" font-weight="bold">{room}/</text>')
    print(f'<text x="{left[column]}" y="48" font-size="11" fill="#666">{len(files[room])} concepts, {count} includes '
          f'inside</text>')
    for name in files[room]:
        print(f'<text x="{left[column]}" y="{place[name][1]}" font-size="10">{name[len(room) + 1:]}</text>')
print("</svg>")
