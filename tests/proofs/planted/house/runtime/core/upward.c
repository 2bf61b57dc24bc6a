/* SPDX-License-Identifier: Apache-2.0 */
#include "stream/planted_stream.h"
