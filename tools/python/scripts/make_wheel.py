#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs a built package as a wheel for this Python and this system.

    make_wheel.py PACKAGE OUT     PACKAGE is build/python/chaintrue; prints the wheel's name

The same package gives the same bytes. The wheel holds no library besides its own: it needs those of
Debian 12 that the module was linked with, which its METADATA lists.
"""

import importlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile

NAME = "chaintrue"


def tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    system = re.sub(r"[-.]", "_", sysconfig.get_platform())
    return f"{python}-{python}-{system}"


def libraries(module):
    """What it was linked with, by the names that the loader looks for."""
    shown = subprocess.run(["objdump", "-p", module], check=True, capture_output=True, text=True)
    return re.findall(r"NEEDED\s+(\S+)", shown.stdout)


def version_of(package):
    sys.path.insert(0, str(package.parent))
    return importlib.import_module(NAME).__version__


def metadata(version, needed):
    external = "".join(f"Requires-External: {library}\n" for library in needed)
    return f"""\
Metadata-Version: 2.1
Name: {NAME}
Version: {version}
Summary: Calibrates hanging routers: maps, diagnoses, plans, checks and G-code
License: GPL-3.0-or-later
Requires-Python: =={sys.version_info.major}.{sys.version_info.minor}.*
Requires-Dist: numpy>=1.24
Provides-Extra: frames
Requires-Dist: pandas; extra == "frames"
Provides-Extra: plots
Requires-Dist: matplotlib; extra == "plots"
{external}"""


def make(package, out):
    version = version_of(package)
    (module,) = package.glob("_core*.so")
    with tempfile.TemporaryDirectory() as scratch:
        info = pathlib.Path(scratch, f"{NAME}-{version}.dist-info")
        info.mkdir()
        (info / "METADATA").write_text(metadata(version, libraries(module)))
        (info / "WHEEL").write_text(
            f"Wheel-Version: 1.0\nGenerator: {NAME}\nRoot-Is-Purelib: false\nTag: {tag()}\n"
        )
        packed = pathlib.Path(scratch, NAME)
        shutil.copytree(package, packed, ignore=shutil.ignore_patterns("__pycache__"))
        # Without the names that only a debugger needs.
        subprocess.run(["strip", "--strip-unneeded", packed / module.name], check=True)
        out.mkdir(parents=True, exist_ok=True)
        subprocess.run(
            [sys.executable, "-m", "wheel", "pack", scratch, "--dest-dir", out],
            env={**os.environ, "SOURCE_DATE_EPOCH": "315532800"},  # 1980: the bytes do not depend on the day
            check=True,
            stdout=subprocess.DEVNULL,
        )
    return out / f"{NAME}-{version}-{tag()}.whl"


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    print(make(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])))
