#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# one_definition.sh ROOT: a type of a named namespace is defined in one file. Two of the same name share their inline
# members when the program is linked: the destructor of one may be called for the other.
set -euo pipefail

# Prints NAMESPACE::NAME FILE FILE … of every type that more than one file under ROOT defines.
defined_twice() {
  cd "$1"
  find lattice jets schemes tools -name '*.[hc]pp' -print0 | sort -z | xargs -0 awk '
    FNR == 1 { depth = 0 }
    /^(inline )?namespace .*\{/ { name = $0; sub(/^(inline )?namespace */, "", name); sub(/ *\{.*/, "", name)
                                  if ($0 !~ /\}/) scope[++depth] = name; next }
    /^\} *\/\/ (inline )?namespace/ { depth--; next }
    { line = $0; sub(/^template <.*> /, "", line) }
    line ~ /^(struct|class|union|enum) / && line !~ /;$/ {
      within = ""; hidden = 0
      for (d = 1; d <= depth; d++) { within = within scope[d] "::"; hidden = hidden || scope[d] == "" }
      if (hidden) next
      sub(/^(struct|class|union|enum( class)?) (alignas\([^)]*\) |\[\[[^]]*\]\] )?/, "", line)
      if (!match(line, /^[A-Za-z0-9_:]+/)) next
      name = within substr(line, 1, RLENGTH)
      if (substr(line, RLENGTH + 1, 1) == "<") next  # a specialisation
      if (file[name] != FILENAME) { files[name] = files[name] " " FILENAME; count[name]++ }
      file[name] = FILENAME
    }
    END { for (name in count) if (count[name] > 1) print name files[name] }' | sort
}

fail() {
  echo "$*" >&2
  exit 1
}

wrong=$(defined_twice "$1")
[ -z "$wrong" ] || fail "$wrong"$'\n'"these types have the name of another; rename one, or put it in an unnamed namespace"

# The check can fail: of the types planted here just those of one name in two files are reported.
planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
mkdir -p "$planted"/{lattice,jets,schemes,tools}
cat >"$planted/lattice/a.hpp" <<'END'
namespace delf {
struct Twice {
  int a;
};
template <class T> class Shape {
};
class Later;
namespace {
struct Hidden {
};
}  // namespace
enum class Kind { a };
}  // namespace delf
END
cat >"$planted/tools/b.cpp" <<'END'
namespace delf {
namespace {
struct Hidden {
};
int f() {
}
}  // namespace
class Later {
};
class Twice final : public Shape<int> {
};
namespace inner {
struct Kind {
};
}  // namespace inner
class Shape {
};
}  // namespace delf
END
reported=$(defined_twice "$planted")
expected='delf::Shape lattice/a.hpp tools/b.cpp
delf::Twice lattice/a.hpp tools/b.cpp'
[ "$reported" = "$expected" ] || fail "planted types were not reported: $reported"
