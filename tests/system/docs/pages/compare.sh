# What a reader of compare.md has: renders of two versions and of a reference, and the plan of a comparison.
. tests/system/docs/pages/renders.bash
