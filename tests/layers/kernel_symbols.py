#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds that code for AVX2 cannot take the place of other code: its object defines no symbol that another
object may define too, which the linker would merge.

    kernel_symbols.py NM OBJECT...      prints every such symbol; 1 where there is one
"""

import subprocess
import sys

# Weak, or unique in the whole program (nm's letters).
MERGED = set("WVuw")
# Eigen under its own name, and a pointer to the runtime's handler of exceptions, no code.
OWN = ("EigenAvx2", "DW.ref.__gxx_personality_v0")


def main():
    nm, objects = sys.argv[1], sys.argv[2:]
    shared, own = [], 0
    for path in objects:
        listed = subprocess.run([nm, "--defined-only", path], capture_output=True, text=True, check=True).stdout
        for line in listed.splitlines():
            letter, symbol = line.split()[-2:]
            own += "EigenAvx2" in symbol
            if letter in MERGED and not any(name in symbol for name in OWN):
                shared.append(f"{symbol} ({letter})")
    if not own:
        shared.append("nothing of EigenAvx2: is this the object?")
    print("\n".join(shared) if shared else f"{own} symbols of its own Eigen, none shared")
    return 1 if shared else 0


if __name__ == "__main__":
    sys.exit(main())
