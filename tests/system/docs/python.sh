# page_python: the interpreter of the Python module in $CRESCENT_BUILD; nothing if there is none.
page_python() {
    local python
    python=$(sed -n 's/^_\?Python_EXECUTABLE:[A-Z]*=//p' "${CRESCENT_BUILD:?the build folder}/CMakeCache.txt" | head -n 1)
    ls "$CRESCENT_BUILD"/python/crescent/_crescent.*.so >/dev/null 2>&1 &&
        "$python" -c 'import numpy, pytest' 2>/dev/null && echo "$python"
    return 0
}
