#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# one_way_includes.sh ROOT: lattice ← jets ← schemes ← tools, and nothing against the arrows.
set -euo pipefail

rooms=(lattice jets schemes tools tests)

# Prints every include that goes against the arrows; fails if there is one.
against_the_arrows() {
  local root=$1 i later found=0
  for ((i = 0; i + 1 < ${#rooms[@]}; ++i)); do
    [ -d "$root/${rooms[i]}" ] || continue
    later=$(IFS='|'; echo "${rooms[*]:i+1}")
    if grep -rnE --include='*.hpp' --include='*.cpp' \
        "^[[:space:]]*#[[:space:]]*include[[:space:]]*[<\"](delf/|(\.\./)+)?($later)/" "$root/${rooms[i]}"
    then
      found=1
    fi
  done
  return "$found"
}

if ! against_the_arrows "$1"; then
  echo "the includes above go against lattice <- jets <- schemes <- tools" >&2
  exit 1
fi

# The check can fail: one bad include at a time.
planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
for ((i = 0; i < ${#rooms[@]}; ++i)); do
  for ((j = 0; j < ${#rooms[@]}; ++j)); do
    for written in "\"${rooms[j]}/a.hpp\"" "<delf/${rooms[j]}/a.hpp>" "\"../${rooms[j]}/a.hpp\""; do
      rm -rf "${planted:?}"/*
      mkdir -p "$planted/${rooms[i]}/inner"
      echo "#include $written" >"$planted/${rooms[i]}/inner/b.hpp"
      allowed=no
      if against_the_arrows "$planted" >/dev/null; then allowed=yes; fi
      expected=no
      if ((j <= i)); then expected=yes; fi
      if [ "$allowed" != "$expected" ]; then
        echo "${rooms[i]} includes $written: allowed is $allowed, should be $expected" >&2
        exit 1
      fi
    done
  done
done
