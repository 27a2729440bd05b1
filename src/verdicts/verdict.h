// Verdicts and judgements, for those who include the verdicts alone.
#pragma once

#include "judgements/verdict.h"
