"""The command `crescent` of the package: the program in it replaces this process.

It is not part of the package: importing the package imports NumPy, which takes longer than the program does.
"""

import os
import sys


_FOLDERS = {"--include-dir": "include", "--cmake-dir": os.path.join("share", "cmake", "crescent")}


def main() -> None:
    """Prints the folder of the headers or of the CMake package, or becomes the program, which starts this interpreter for
    samplers in Python."""
    package = os.path.join(os.path.dirname(os.path.abspath(__file__)), "crescent")
    if len(sys.argv) == 2 and sys.argv[1] in _FOLDERS:
        print(os.path.join(package, _FOLDERS[sys.argv[1]]))
        return
    program = os.path.join(package, "bin", "crescent")
    os.environ.setdefault("CRESCENT_PYTHON", sys.executable)
    # `crescent sweep` finds crescent-sweep of this environment even where the environment is not activated.
    os.environ["PATH"] = os.pathsep.join([os.environ.get("PATH", os.defpath), os.path.dirname(sys.executable)])
    try:
        os.execv(program, ["crescent", *sys.argv[1:]])
    except OSError as error:
        print(f"{program}: {error.strerror}", file=sys.stderr)
        sys.exit(3)
