/* The C interface of samplers in shared libraries, docs/plugins.md. */
#include "check/sampler_plugin.h"
