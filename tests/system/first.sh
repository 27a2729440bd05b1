#!/bin/bash
# The first examples of the documentation, those of README.md, run as they are printed; docs.sh runs the others.
. "$(dirname "$0")/common.sh"
. "$here/docs/python.sh"
python3 "$here/docs/run_blocks.py" --source "$CRESCENT_SOURCE" --build "$CRESCENT_BUILD" --python "$(page_python)" \
    --work "$work/pages" "$CRESCENT_SOURCE/README.md"
