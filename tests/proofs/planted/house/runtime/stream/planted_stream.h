#include "core/planted_fixed.h"
