/* SPDX-License-Identifier: Apache-2.0 */
#include "api/build_checks.h"

t3r_status t3r_order_fault(const t3r_runtime *rt, const t3r_request *request, const t3r_build_order *order,
                           t3r_fault *fault)
{
    return t3r_order_checks(rt, request, order, fault);
}
