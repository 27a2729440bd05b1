"""``python -m crescent_shader``: see :mod:`crescent_shader`."""

import sys

from .host import main

sys.exit(main())
