/* SPDX-License-Identifier: Apache-2.0 */
#include "core/planted_fixed.h"
