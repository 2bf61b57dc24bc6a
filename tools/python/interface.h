/* SPDX-License-Identifier: Apache-2.0 */
/* The functions that the Python package calls: all that these headers declare. declare.py reads them. */
#ifndef TRIM3R_PYTHON_INTERFACE_H
#define TRIM3R_PYTHON_INTERFACE_H

#include "geometry/seen.h"
#include "host/cpu.h"
#include "pictures/metrics.h"
#include "recording/recording.h"
#include "room/room.h"
#include "trim3r.h"
#include "trim3r_heads.h"
#include "trim3r_host.h"

#endif
