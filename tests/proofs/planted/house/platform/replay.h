#include "core/fixed.h"
