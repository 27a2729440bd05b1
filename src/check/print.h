// What writes a judgement, for those who include the verdicts alone.
#pragma once

#include "judgements/print.h"
