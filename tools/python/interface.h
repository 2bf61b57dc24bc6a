/* What the Python package calls: every function that these headers declare. declare.py reads them. */
#ifndef TRIM3R_PYTHON_INTERFACE_H
#define TRIM3R_PYTHON_INTERFACE_H

#include "cpu.h"
#include "pictures/metrics.h"
#include "recording.h"
#include "room/room.h"
#include "scene/scene_file.h"
#include "threads.h"
#include "trim3r.h"
#include "trim3r_heads.h"

#endif
