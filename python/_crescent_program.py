"""The command `crescent` of the package: the program in it replaces this process.

It is not part of the package: importing the package imports NumPy, which takes longer than the program does.
"""

import os
import sys


def main() -> None:
    """Becomes the program, which starts this interpreter for samplers in Python."""
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "crescent", "bin", "crescent")
    os.environ.setdefault("CRESCENT_PYTHON", sys.executable)
    # `crescent sweep` finds crescent-sweep of this environment even where the environment is not activated.
    os.environ["PATH"] = os.pathsep.join([os.environ.get("PATH", os.defpath), os.path.dirname(sys.executable)])
    try:
        os.execv(program, ["crescent", *sys.argv[1:]])
    except OSError as error:
        print(f"{program}: {error.strerror}", file=sys.stderr)
        sys.exit(3)
