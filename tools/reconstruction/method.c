/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/method.h"

#include "cli/cli.h"

static int build(method_source *source, const t3r_recording *recording, const char *path,
                 const reconstruction_options *options, reconstruction *made, reconstruction_account *account)
{
    (void)source;
    const int code = reconstruction_build(made, recording, path, options);
    if (code == CLI_OK) {
        *account = reconstruction_account_of(made);
    }
    return code;
}

const method method_trim3r = {.name = "trim3r", .allocates = true, .refines = true, .build = build};
