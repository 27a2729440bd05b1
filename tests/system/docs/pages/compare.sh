# Prepares for compare.md: renders of two versions and of a reference, and the plan of a comparison.
. tests/system/docs/pages/renders.bash
