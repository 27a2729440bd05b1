"""``python -m crescent`` is the command ``crescent``."""

from _crescent_program import main

main()
