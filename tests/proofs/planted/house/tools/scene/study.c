#include "study/rivals/rival.h"
