#include "study/rivals/planted_rival.h"
