#!/bin/bash
# site_pages.sh DIR: makes the pages of docs/ and the reference of the public headers, those of include/ and what
# crescent.h and check.h include of src/, as a site in DIR, and completes its search field. Needs doxygen.
set -eu
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd)
cd "$root"
headers=$(sed -nE 's/^#include "([^"]+)".*/src\/\1/p' include/crescent/*.h | sort -u |
    while read -r header; do [ ! -f "$header" ] || printf '%s ' "$header"; done)
{
    cat docs/Doxyfile
    echo "PROJECT_NUMBER = $(cat VERSION)"
    echo "INPUT = README.md CONTRIBUTING.md SECURITY.md docs include/crescent $headers"
    echo "OUTPUT_DIRECTORY = $1"
} | doxygen -
/usr/bin/python3 tools/site_search.py "$1"
