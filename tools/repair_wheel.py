"""repair_wheel.py WHEEL FOLDER: auditwheel, with every library but the C and C++ runtimes put into the wheel.

auditwheel takes GLib, X11, expat and zlib for a part of every Linux. They are on every desktop, but not in a container
or on a server, and Pango and Cairo need them. So its policy is reduced to what is there wherever Python is.
"""

import json
import sys
import tempfile
from pathlib import Path

import auditwheel.main
import auditwheel.policy
from auditwheel.libc import Libc

PLATFORM = "manylinux_2_36_x86_64"
# Sonames, to their first dot.
EVERYWHERE = {"libc", "libm", "libmvec", "libdl", "libpthread", "librt", "libresolv", "libutil", "libgcc_s", "libstdc++"}


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
        return auditwheel.main.main() or 0


if __name__ == "__main__":
    sys.exit(main())
