#!/bin/bash
# The documentation as a site, without the reference of the Python package: no link of it is broken, and its search
# field finds headings. tests/system/pages.sh has what the field is given.
. "$(dirname "$0")/common.sh"
command -v doxygen >/dev/null || skip "no doxygen here"
mkdir site
expect 0 "$CRESCENT_SOURCE/tools/site_pages.sh" "$work/site"
grep -q "[1-9][0-9][0-9]\+ entries of the pages in the search field" printed ||
    die "the search field: $(tail -n 3 printed)"
expect 0 /usr/bin/python3 "$CRESCENT_SOURCE/tools/site_links.py" site "$CRESCENT_SOURCE"
grep -q "MSearchBox\|searchBox" site/index.html || die "the first page has no search field"
grep -qF '"A reservoir", ["../md_docs_domains.html#' site/search/all_*.js || die "no heading is found"
grep -qF '"--until", ["../md_docs_suites.html#' site/search/all_*.js || die "no option is found"
