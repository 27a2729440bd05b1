"""``python -m crescent_shader``: see :mod:`crescent_shader`."""

import os
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # its idle threads take cores from the device, and nothing uses them

from .host import main  # noqa: E402: NumPy starts those threads when it is imported

sys.exit(main())
