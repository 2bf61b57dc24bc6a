#include "stream/planted_stream.h"
