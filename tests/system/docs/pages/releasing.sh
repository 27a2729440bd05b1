# What a maintainer who reads docs/releasing.md has after its first step: a version whose changes have a number and a date.
sed -i "s/^## \[Unreleased\]/## [9.0.0] - 2026-01-02\n\n- A change./" CHANGELOG.md
echo 9.0.0 >VERSION
