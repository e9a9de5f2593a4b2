# SPDX-License-Identifier: MIT
"""check_page.py PAGE: fails where a page is not well-formed, has an id twice or a link to none, could run or load
anything, has an image without words for it, or a colour of text that is hard to read."""
import base64
import os
import re
import sys
import urllib.parse
import xml.etree.ElementTree as tree


def fail(message):
    sys.exit(f"{sys.argv[1]}: {message}")


def luminance(colour):
    """The relative luminance of WCAG 2."""
    parts = [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    a, b = sorted((luminance(one), luminance(other)), reverse=True)
    return (a + 0.05) / (b + 0.05)


text = open(sys.argv[1], encoding="utf-8").read()
try:
    page = tree.fromstring(text.removeprefix("<!DOCTYPE html>"))
except tree.ParseError as error:
    fail(f"not well-formed: {error}")

ids = [e.get("id") for e in page.iter() if e.get("id")]
if len(ids) != len(set(ids)):
    fail("an id is there twice")
for element in page.iter():
    if element.tag in ("script", "link", "iframe", "object", "embed", "form", "base"):
        fail(f"has an element {element.tag}")
    for name, value in element.attrib.items():
        if name.startswith("on") or name == "style":
            fail(f"has an attribute {name}")
        beside = os.path.join(os.path.dirname(sys.argv[1]), urllib.parse.unquote(value))
        is_film = value.endswith(("film.mp4", "film.gif")) and os.path.exists(beside)
        if name == "href" and not (value.startswith("#") and value[1:] in ids) and not is_film:
            fail(f"links to {value}, which is neither in it nor a film beside it")
        if name == "src" and not value.startswith("data:image/"):
            fail(f"loads {value[:60]}")
        if name == "aria-labelledby" and value not in ids:
            fail(f"is labelled by {value}, which is not in it")
for image in page.iter("img"):
    if not image.get("alt", "").strip():
        fail("has an image without words for it")
    head, data = image.get("src").split(",", 1)
    if head == "data:image/svg+xml":
        tree.fromstring(urllib.parse.unquote(data))
    elif not base64.b64decode(data, validate=True).startswith(b"\x89PNG"):
        fail("has an image that is neither SVG nor PNG")

policy = [m.get("content") for m in page.iter("meta") if m.get("http-equiv") == "Content-Security-Policy"]
if policy != ["default-src 'none'; img-src data:; style-src 'unsafe-inline'"]:
    fail(f"has the policy {policy}")

schemes = re.findall(r":root \{([^}]*)\}", page.find(".//style").text)
if len(schemes) != 3:
    fail("has other colours than light, dark and those for paper")
for scheme in schemes:
    colours = dict(re.findall(r"--(\w+): (#[0-9a-f]{6})", scheme))
    for of_text in ("text", "quiet", "link", "good", "bad"):
        for ground in ("ground", "panel"):
            if contrast(colours[of_text], colours[ground]) < 4.5:
                fail(f"{of_text} on {ground} has a contrast of {contrast(colours[of_text], colours[ground]):.2f}")
for sheet in (page.find(".//style").text,):
    if re.search(r"url\(|@import", sheet):
        fail("a style loads something")
