// What writes a judgement, for those who include the verdicts alone.
#pragma once

#include "check/report/print.h"
