# SPDX-License-Identifier: MIT
"""python3 -m delf: the program delf; python3 -m delf test: quick checks of an installed package."""
import os
import sys

import delf


def main() -> int:
    if sys.argv[1:2] == ["test"]:
        from delf._selftest import main as test
        return test()
    path = delf.program()
    os.execv(path, [path, *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
