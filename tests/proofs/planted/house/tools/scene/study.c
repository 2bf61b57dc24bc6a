/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/planted_rival.h"
