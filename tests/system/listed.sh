#!/bin/bash
# What an import of a model does not take along has a line with a count; statements, options and files of OBJ and MTL.
. "$(dirname "$0")/common.sh"
[ -x "$(dirname "$CRESCENT")/crescent-import" ] || command -v crescent-import >/dev/null || skip "this build has no importer"
expect 0 python3 "$here/listed_models.py" "$CRESCENT"
