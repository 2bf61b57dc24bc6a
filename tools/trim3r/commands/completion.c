/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r completion: the scripts by which a shell completes commands, options and files. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/whole_file.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"

/* Contents of completion.bash and the like (tools/CMakeLists.txt). */
extern const char completion_bash[], completion_zsh[], completion_fish[];

static const struct {
    const char *shell, *script;
} scripts[] = {{"bash", completion_bash}, {"zsh", completion_zsh}, {"fish", completion_fish}};
enum { SHELLS = sizeof scripts / sizeof scripts[0] };

typedef struct completion_options {
    const char *shell;
    const char *output; /* NULL = standard output */
} completion_options;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    completion_options *o = state->input;
    switch (key) {
    case 'o':
        o->output = arg;
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, arg, (const char **[]){&o->shell}, 1);
        return 0;
    case ARGP_KEY_END:
        if (o->shell == NULL) {
            argp_error(state, "the shell is missing: bash, zsh or fish");
        }
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option options[] = {
    {"output", 'o', "FILE", OPTION_WRITES(FILE_OTHER) | OPTION_PIPE, "script to write (standard output)", 0},
    {0},
};
static const struct argp argp = {
    .options = options,
    .parser = parse,
    .args_doc = "bash|zsh|fish",
    .doc = "Print the script by which a shell completes commands, options and files of trim3r."
           "\vExamples:\n"
           "  source <(trim3r completion bash)\n"
           "  trim3r completion zsh -o _trim3r\n"
           "  trim3r completion fish -o ~/.config/fish/completions/trim3r.fish",
};

static int write_script(const char *path, const char *script)
{
    t3r_whole_file file;
    char error[512] = "";
    if (whole_file_begin(&file, path, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    fputs(script, file.stream);
    if (t3r_whole_file_commit(&file, NULL, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    printf("%s: completion of commands, options and files\n", path);
    return CLI_OK;
}

int command_completion(int argc, char **argv)
{
    completion_options o = {0};
    file_options_parse(&argp, argc, argv, &o);
    for (int i = 0; i < SHELLS; i++) {
        if (strcmp(o.shell, scripts[i].shell) == 0) {
            if (o.output != NULL) {
                return write_script(o.output, scripts[i].script);
            }
            fputs(scripts[i].script, stdout);
            return CLI_OK;
        }
    }
    return cli_error(CLI_BAD_USAGE, "there is no script for '%s'; there are bash, zsh and fish", o.shell);
}
