#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check_site.py SITE: every link of the handbook leads to a page, and a place in it, that exists; nothing is loaded from elsewhere."""

import html.parser
import pathlib
import sys
import tempfile
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.ids, self.links, self.loads = set(), [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.ids.update(value for name, value in attributes if name in ("id", "name") and value)
        if "href" in given and given.get("rel") != "canonical":
            (self.loads if tag == "link" else self.links).append(given["href"])
        self.loads += [given[name] for name in ("src", "poster") if given.get(name)]


def faults(site):
    pages = {path: Page(path.read_text()) for path in sorted(site.rglob("*.html")) if path.name != "404.html"}
    for path, page in pages.items():
        for address in page.links + page.loads:
            parts = urllib.parse.urlsplit(address)
            if parts.scheme or parts.netloc:
                if address in page.loads and parts.scheme != "data":
                    yield f"{path.relative_to(site)}: loads {address}"
                continue
            to = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if to.is_dir():
                to /= "index.html"
            if not to.exists():
                yield f"{path.relative_to(site)}: {address}: no such file"
            elif parts.fragment and to in pages and parts.fragment not in pages[to].ids:
                yield f"{path.relative_to(site)}: {address}: no such place"


site = pathlib.Path(sys.argv[1]).resolve()
with tempfile.TemporaryDirectory() as folder:  # the check can fail
    (pathlib.Path(folder) / "index.html").write_text(
        '<a href="none.html"></a><a href="#none"></a><script src="https://elsewhere.org/x.js"></script>')
    if len(list(faults(pathlib.Path(folder).resolve()))) != 3:
        sys.exit("the check finds nothing in a broken page")
found = list(faults(site))
print(*found[:40], f"{len(list(site.rglob('*.html')))} pages, {len(found)} faults", sep="\n")
sys.exit(1 if found else 0)
