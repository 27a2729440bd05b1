// The interface of a plugin, for those who include the verdicts alone.
#pragma once

#include "subjects/sampler_plugin.h"
