// What writes a result, for those who include the verdicts alone.
#pragma once

#include "check/report/print.h"
