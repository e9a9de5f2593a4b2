#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# site.sh MKDOCS KATEX WORK: WORK/site, of WORK/pages. A warning of mkdocs is an error.
set -euo pipefail
here=$(dirname "$(realpath "$0")")
katex=$3/pages/theme/katex
mkdir -p "$katex"
cp "$here"/theme/* "$3/pages/theme"
cp -rL "$2"/katex.min.css "$2"/katex.min.js "$2"/contrib/auto-render.js "$2"/fonts "$katex"
DELF_PAGES=$3/pages DELF_SITE=$3/site "$1" build --quiet --strict --config-file "$here/mkdocs.yml"
python3 - "$3/site" <<'END'
import json, pathlib, sys
site = pathlib.Path(sys.argv[1])
worker = next(site.glob("assets/javascripts/workers/search.*.js")).read_text()
(site / "search/local.js").write_text(
    f"window.__search = {{ index: Promise.resolve({(site / 'search/search_index.json').read_text()}),\n"
    f"  worker: URL.createObjectURL(new Blob([{json.dumps(worker)}])) }};\n")
END
echo "$3/site/index.html"
