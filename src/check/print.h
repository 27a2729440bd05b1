// The output functions of a result, for code that includes only the verdicts.
#pragma once

#include "check/report/print.h"
