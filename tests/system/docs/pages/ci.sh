# What a reader of docs/ci.md has: renders.
. tests/system/docs/pages/renders.bash
