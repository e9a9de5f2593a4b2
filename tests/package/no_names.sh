#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# no_names.sh ROOT: what a theory, a method or a state does is declared by its entry; nobody else compares with its name.
set -euo pipefail

owners=(schemes/theories schemes/methods schemes/states)

# The names of all entries, as alternatives of a regular expression.
names_in() {
  local root=$1 folder
  for folder in "${owners[@]}"; do
    grep -rhPzo --include='*.cpp' '(Theory|Method|State)Entry\s+\w+\s*\{\s*(\.name\s*=\s*)?"\K[^"]+' "$root/$folder" |
      tr '\0' '\n'
  done | sort -u | paste -sd '|'
}

# Prints every comparison with one of the names outside the folders of their owners; fails if there is one.
comparisons() {
  local root=$1 name="\"($2)\"" calls='(\.(find|contains|starts_with|ends_with|compare)|strcmp)\([^;{}"]*'
  ! grep -rPzo --include='*.hpp' --include='*.cpp' --exclude-dir={theories,methods,states} \
      "[!=]=\s*$name|$name\s*[!=]=|$calls$name" "$root"/{lattice,jets,schemes,tools} | tr '\0' '\n'
}

names=$(names_in "$1")
for known in sine-gordon wave-map multisymplectic r-adaptive kink file; do
  if ! grep -qE "^($names)$" <<<"$known"; then
    echo "$known is not found among the names of entries: $names" >&2
    exit 1
  fi
done
if ! comparisons "$1" "$names"; then
  echo "the comparisons above test for a theory, a method or a state by its name; let its entry declare the difference" >&2
  exit 1
fi

# The check can fail: one bad line at a time; and names may be written where nothing is compared.
planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
mkdir -p "$planted"/{lattice,jets,schemes/methods,tools/run}
expect() {
  local expected=$1 place=$2 line=$3 allowed=no
  echo "$line" >"$planted/$place"
  if comparisons "$planted" "$names" >/dev/null; then allowed=yes; fi
  rm "$planted/$place"
  if [ "$allowed" != "$expected" ]; then
    echo "$place: $line: allowed is $allowed, should be $expected" >&2
    exit 1
  fi
}
expect no tools/run/a.cpp 'if (p.method == "spacetime") return 1;'
expect no tools/run/a.cpp 'if ("kepler" != p.theory) return 1;'
expect no tools/run/a.cpp 'return scene.initial.name == "file";'
expect no tools/run/a.hpp 'return theory.find("sine-gordon") != npos;'
expect no schemes/a.cpp $'return p.method ==\n    "r-adaptive";'
expect yes schemes/methods/a.cpp 'if (p.theory != "sine-gordon") refuse();'
expect yes tools/run/a.cpp 'p.theory = "klein-gordon";'
expect yes tools/run/a.cpp 'for (const char* theory : {"klein-gordon", "phi4"}) add(theory);'
