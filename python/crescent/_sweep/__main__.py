"""``crescent sweep``: the command ``crescent-sweep`` (``python -m crescent._sweep``)."""

from .command import main

if __name__ == "__main__":
    raise SystemExit(main())
