/* SPDX-License-Identifier: Apache-2.0 */
#include "planted_replay.h"
