# Prepares for README.md: a sampler as a program and as a library, and renders.
cc -O2 -o mine examples/pipe_samplers/cosine.c -lm
cc -O2 -shared -fPIC -I include -I src -o libmine.so examples/plugin/cosine.c -lm
. tests/system/docs/pages/renders.bash
