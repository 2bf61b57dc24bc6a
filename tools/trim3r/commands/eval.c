/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r eval: scores of rendered views against recorded ones. */
#include "trim3r/commands/commands.h"

#include "cli/cli.h"
#include "cli/options/file_options.h"
#include "evaluation/run.h"

int command_eval(int argc, char **argv)
{
    evaluation_options o;
    evaluation_contestants contestants = {.count = 0};
    evaluation_defaults(&o);
    file_options_parse(&evaluation_argp, argc, argv, &o);
    int code = CLI_OK;
    if (o.settings.scene != NULL) {
        evaluation_contestants_scene(&contestants, &o.settings);
    } else {
        code = evaluation_contestants_add_heads(&contestants, o.heads, o.head_count, &o.settings);
    }
    code = code == CLI_OK ? evaluation_run(&o, &contestants) : code;
    evaluation_options_free(&o);
    return code;
}
