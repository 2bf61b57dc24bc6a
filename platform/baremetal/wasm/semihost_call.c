/* SPDX-License-Identifier: Apache-2.0 */
#include "semihost_call.h"

#include "host.h"

int32_t semihost_call(uint32_t operation, const void *block)
{
    return host_semihost(operation, block);
}
