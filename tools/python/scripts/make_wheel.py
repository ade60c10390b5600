#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs a built package as a wheel for this Python and this system (PEP 427), with Python alone.

    make_wheel.py PACKAGE OUT     PACKAGE is build/python/chaintrue; prints the wheel's name

The same package gives the same bytes. The wheel holds no library besides its own: it needs those of
Debian 12 that the module was linked with, which its METADATA lists.
"""

import base64
import hashlib
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

NAME = "chaintrue"


def tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    system = re.sub(r"[-.]", "_", sysconfig.get_platform())
    return f"{python}-{python}-{system}"


def stripped(module):
    """The compiled module without the names that only a debugger needs."""
    with tempfile.TemporaryDirectory() as scratch:
        copy = pathlib.Path(scratch, module.name)
        shutil.copyfile(module, copy)
        subprocess.run(["strip", "--strip-unneeded", copy], check=True)
        return copy.read_bytes()


def libraries(module):
    """What it was linked with, by the names that the loader looks for."""
    shown = subprocess.run(["objdump", "-p", module], check=True, capture_output=True, text=True)
    return re.findall(r"NEEDED\s+(\S+)", shown.stdout)


def version_of(package):
    shown = subprocess.run(
        [sys.executable, "-c", f"import {NAME}; print({NAME}.__version__)"],
        cwd=package.parent,
        check=True,
        capture_output=True,
        text=True,
    )
    return shown.stdout.strip()


def metadata(version, needed):
    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    return "\n".join(
        [
            "Metadata-Version: 2.1",
            f"Name: {NAME}",
            f"Version: {version}",
            "Summary: Calibrates hanging routers: maps, diagnoses, plans, checks and G-code",
            "License: GPL-3.0-or-later",
            f"Requires-Python: =={python}.*",
            "Requires-Dist: numpy>=1.24",
            "Provides-Extra: frames",
            'Requires-Dist: pandas; extra == "frames"',
            "Provides-Extra: plots",
            'Requires-Dist: matplotlib; extra == "plots"',
            *(f"Requires-External: {library}" for library in needed),
            "",
        ]
    )


def members(package, version):
    """Everything in the wheel besides its RECORD: a name and its bytes."""
    info = f"{NAME}-{version}.dist-info"
    (module,) = package.glob("_core*.so")
    wheel = f"Wheel-Version: 1.0\nGenerator: {NAME}\nRoot-Is-Purelib: false\nTag: {tag()}\n"
    sources = [p for p in package.iterdir() if p.suffix in (".py", ".pyi") or p.name == "py.typed"]
    for source in sorted(sources):
        yield f"{NAME}/{source.name}", source.read_bytes()
    yield f"{NAME}/{module.name}", stripped(module)
    yield f"{info}/METADATA", metadata(version, libraries(module)).encode()
    yield f"{info}/WHEEL", wheel.encode()


def record_line(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def make(package, out):
    version = version_of(package)
    path = out / f"{NAME}-{version}-{tag()}.whl"
    record = ""
    out.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:

        def add(name, content):
            entry = zipfile.ZipInfo(name)  # of 1980, so that the bytes do not depend on the day
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, content)

        for name, content in members(package, version):
            add(name, content)
            record += record_line(name, content)
        own = f"{NAME}-{version}.dist-info/RECORD"
        add(own, (record + f"{own},,\n").encode())
    return path


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    print(make(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])))
