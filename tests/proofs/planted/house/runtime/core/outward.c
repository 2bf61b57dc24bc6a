#include "planted_replay.h"
