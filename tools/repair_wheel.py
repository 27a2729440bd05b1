"""repair_wheel.py WHEEL FOLDER: auditwheel, with every library but the C and C++ runtimes put into the wheel.

auditwheel takes GLib, X11, expat and zlib for a part of every Linux. They are on every desktop, but not in a container
or on a server, and Pango and Cairo need them. So its policy is reduced to what is there wherever Python is. The licences
of the libraries and of the font, as Debian's packages state them, go into the wheel too.
"""

import json
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import auditwheel.main
import auditwheel.policy
from auditwheel.libc import Libc
from auditwheel.wheeltools import InWheelCtx

PLATFORM = f"manylinux_2_36_{platform.machine()}"
# Sonames, to their first dot.
EVERYWHERE = {"libc", "libm", "libmvec", "libdl", "libpthread", "librt", "libresolv", "libutil", "libgcc_s", "libstdc++"}


def packages_of(libraries: list[str]) -> set[str]:
    """Debian's packages that have these libraries."""
    search = ["dpkg-query", "-S", *(f"*/{name}" for name in libraries)]
    found = subprocess.run(search, capture_output=True, text=True, check=False).stdout
    return {line.partition(":")[0] for line in found.splitlines()}


def add_licences(wheel: Path) -> None:
    """Puts the copyright files of what came from Debian into the wheel."""
    with InWheelCtx(wheel) as inside:
        inside.out_wheel = wheel
        grafted = [re.sub(r"-[0-9a-f]{8}\.", ".", path.name) for path in inside.path.glob("*.libs/*")]
        licences = next(inside.path.glob("*.dist-info")) / "licenses"
        for package in sorted(packages_of(grafted) | {"fonts-inter"}):
            text = Path("/usr/share/doc", package, "copyright")
            if text.is_file():
                shutil.copy(text, licences / f"{package}.txt")


def main() -> int:
    """Repairs one wheel; auditwheel's exit code."""
    wheel, folder = sys.argv[1:]
    policies = json.loads(auditwheel.policy._POLICY_JSON_MAP[Libc.GLIBC].read_text())
    for policy in policies:
        policy["lib_whitelist"] = [name for name in policy["lib_whitelist"] if name.partition(".")[0] in EVERYWHERE]
    with tempfile.TemporaryDirectory() as work:
        reduced = Path(work) / "policy.json"
        reduced.write_text(json.dumps(policies))
        auditwheel.policy._POLICY_JSON_MAP[Libc.GLIBC] = reduced
        sys.argv = ["auditwheel", "repair", "--strip", "--only-plat", "--plat", PLATFORM, "-w", folder, wheel]
        code = auditwheel.main.main() or 0
    for repaired in Path(folder).glob("*.whl") if code == 0 else ():
        add_licences(repaired)
    return code


if __name__ == "__main__":
    sys.exit(main())
