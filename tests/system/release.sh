#!/bin/bash
# The parts of a release that need no network: tag, version and changes fit, the text of the release, the metadata of its
# DOI; what does not fit is named. The workflow is that of docs/releasing.md, with the same addresses.
. "$(dirname "$0")/common.sh"
mkdir -p tree/tools && cd tree || exit 1
cp "$CRESCENT_SOURCE"/{VERSION,CHANGELOG.md,CITATION.cff} . && cp "$CRESCENT_SOURCE"/tools/{release.py,addresses.txt} tools
release() { python3 tools/release.py "$@"; }
version=$(cat VERSION)

# Changes that no version has stop a release; without a tag they do not.
printf '## [Unreleased]\n\n### Added\n\n- x\n\n' >new.md
sed -i '/^## \[Unreleased\]/,/^## \[[0-9]/{/^## \[[0-9]/!d}' CHANGELOG.md
cp CHANGELOG.md released.md
cat new.md released.md >CHANGELOG.md
expect 0 release check
expect 1 release check "v$version"
grep -q "CHANGELOG.md: expected no changes below \[Unreleased\]; move them to \[$version\]" said ||
    die "not named: $(cat said)"
cp released.md CHANGELOG.md
expect 0 release check
expect 0 release check "v$version"
expect 1 release check "v$version.1"
grep -q "expected the tag v$version" said || die "the tag is not named: $(cat said)"
expect 0 release notes
grep -q '^### ' printed && ! grep -q '^## ' printed || die "not the text of one version: $(head -n 3 printed)"
expect 0 release metadata doi.json
python3 - "$version" <<'PY' || die "the metadata: $(cat doi.json)"
import json, sys
made = json.load(open("doi.json"))
required = {"doi", "creators", "titles", "publisher", "publicationYear", "types", "schemaVersion"}  # of DataCite 4.5
assert required <= made.keys() and made["version"] == sys.argv[1] and made["creators"][0]["name"]
assert made["dates"][0]["date"].startswith(made["publicationYear"])
PY
for name in repository index doi; do
    expect 0 release address $name
    [ -s printed ] || die "no address '$name'"
done
expect 1 release address indx
grep -q "tools/addresses.txt: expected one of" said || die "an unknown address: $(cat said)"
echo 9.9.9 >VERSION
expect 1 release check
grep -q "CHANGELOG.md: expected '## \[9.9.9\]" said || die "a version without changes: $(cat said)"
printf '## [9.9.9] - 2026-01-02\n\n## [9.9.8] - 2026-01-01\n\n- x\n' >CHANGELOG.md
expect 1 release notes
expect 2 release nothing

# Each command and each address that the workflow takes is there.
workflow=$CRESCENT_SOURCE/.github/workflows/release.yml
cp "$CRESCENT_SOURCE"/{VERSION,CHANGELOG.md} .
grep -o 'tools/release.py [a-z]*\( [a-z]*\)\?' "$workflow" | sort -u >calls
[ "$(wc -l <calls)" -eq 4 ] || die "other calls than four: $(cat calls)"
for made in wheel site page; do
    grep -q "\./$made" "$workflow" && [ -x "$CRESCENT_SOURCE/$made" ] || die "the workflow does not call ./$made"
done
