/* SPDX-License-Identifier: Apache-2.0 */
#include "trim3r/front.h"

#include <argp.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "cli/tables/json_output.h"
#include "cli/text/edit_distance.h"
#include "cli/text/style.h"
#include "host/text.h"
#include "trim3r.h"
#include "trim3r/commands/commands.h"

static const trim3r_command product[] = {
    {"scene", command_scene, "turn photos, a folder, a bag or a recording into a scene"},
    {"import", command_import, "turn a folder of posed pictures into a recording"},
    {"capture", command_capture, "record a live camera, or turn it straight into Gaussians"},
    {"room", command_room, "write the built-in room as a recording"},
    {"info", command_info, "show what recordings and scenes hold"},
    {"build", command_build, "turn frames of a recording into exactly Z Gaussians"},
    {"convert", command_convert, "turn a scene file into another format"},
    {"render", command_render, "draw a scene as a recorded camera, a pose or a trajectory sees it"},
    {"view", command_view, "show a scene or a recording in a browser"},
    {"eval", command_eval, "score rendered views against recorded ones"},
    {"replay", command_replay, "print the hash of every stage, and compare with an earlier run"},
    {"diff", command_diff, "compare two scenes or two views"},
    {"plan", command_plan, "list an arena's buffers and bytes before anything runs"},
    {"bench", command_bench, "time each stage on this machine"},
    {"doctor", command_doctor, "list what this machine and this build have, and check their bits"},
    {"head-info", command_head_info, "show a head's layers, multiply-accumulates and bytes"},
    {"completion", command_completion, "print the script by which a shell completes commands"},
};
enum { PRODUCT_COUNT = sizeof product / sizeof product[0] };

/* Named in the refusal of a program without them. */
static const char *const of_study[] = {"chart", "stress", "quantize"};

/* The product's, then those added under `heading`. */
#define COMMANDS_MOST 32u
static struct {
    trim3r_command list[COMMANDS_MOST];
    uint32_t count;
    const char *heading;
} commands;

/* NULL where there is none. */
static trim3r_command *command_named(const char *name)
{
    trim3r_command *found = NULL;
    for (uint32_t i = 0; i < commands.count; i++) {
        found = strcmp(name, commands.list[i].name) == 0 ? &commands.list[i] : found;
    }
    return found;
}

static void list_commands(const trim3r_extension *added)
{
    memcpy(commands.list, product, sizeof product);
    commands.count = PRODUCT_COUNT;
    commands.heading = added != NULL ? added->heading : NULL;
    for (uint32_t i = 0; added != NULL && i < added->count; i++) {
        if (added->commands[i].summary == NULL) {
            command_named(added->commands[i].name)->run = added->commands[i].run;
        } else {
            commands.list[commands.count++] = added->commands[i];
        }
    }
}

static const char about[] = "Turn a few camera frames into a budgeted set of 3-D Gaussians, and draw views of\n"
                            "it, in integers.\n";
static const char data_flow[] = "  photos|DIR|BAG|REC.mcap > scene > SCENE.ply or PAGE.html\n\n"
                                "  import|capture|room > REC.mcap > build > SCENE.ply > render > view.png\n"
                                "                        REC.mcap > eval > scores.csv\n"
                                "                        REC.mcap > replay > hashes\n\n"
                                "  trim3r room -o room.mcap\n"
                                "  trim3r build room.mcap --context 0,2 --keep 10% -o scene.ply\n"
                                "  trim3r render scene.ply room.mcap --view 1 -o view.png\n";

static void print_help(FILE *out)
{
    const char *heading = style_begin(out, STYLE_HEADING), *end = style_end(out);
    fprintf(out, "%sUsage:%s trim3r COMMAND [OPTION...]\n%s\n", heading, end, about);
    for (uint32_t i = 0; i < commands.count; i++) {
        if (i == PRODUCT_COUNT) {
            fprintf(out, "\n%s%s%s\n", heading, commands.heading, end);
        }
        fprintf(out, "  %-10s %s\n", commands.list[i].name, commands.list[i].summary);
    }
    fprintf(out,
            "\n%sData flow:%s\n%s\n"
            "trim3r help COMMAND lists a command's options, as trim3r COMMAND --help does.\n"
            "Exit status: 0 done, 1 bad input, 2 bad usage, 3 budget or arena too small.\n"
            "Commands with results know --json: one object on stdout.\n",
            heading, end, data_flow);
}

/* For completion: a command and what it does, a tab between. */
static void print_commands(void)
{
    for (uint32_t i = 0; i < commands.count; i++) {
        printf("%s\t%s\n", commands.list[i].name, commands.list[i].summary);
    }
}

/* No command has that name; the one that may be meant is named. */
static int refuse(const char *name)
{
    for (size_t i = 0; i < sizeof of_study / sizeof of_study[0]; i++) {
        if (strcmp(name, of_study[i]) == 0) {
            return cli_error(CLI_BAD_USAGE, "%s is part of the study: a program built with -DT3R_STUDY=ON has it",
                             name);
        }
    }
    uint32_t nearest = 0;
    for (uint32_t i = 1; i < commands.count; i++) {
        nearest =
            edit_distance(name, commands.list[i].name) < edit_distance(name, commands.list[nearest].name) ? i : nearest;
    }
    if (edit_distance(name, commands.list[nearest].name) <= EDIT_DISTANCE_NEAR) {
        return cli_error(CLI_BAD_USAGE, "there is no command '%s'; did you mean %s? trim3r --help lists them", name,
                         commands.list[nearest].name);
    }
    return cli_error(CLI_BAD_USAGE, "there is no command '%s'; trim3r --help lists them", name);
}

/* Names of files stand in messages, tables and pages: one that a terminal would obey is refused before any of them. */
static int check_arguments(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (!t3r_text_is_clean(t3r_text_of(argv[i]))) {
            return cli_error(CLI_BAD_USAGE, "argument %d, '%s', has a control character or is not UTF-8", i, argv[i]);
        }
    }
    return CLI_OK;
}

static int run(int argc, char **argv)
{
    if (argc < 2) {
        print_help(stderr);
        return CLI_BAD_USAGE;
    }
    if (argc == 3 && strcmp(argv[1], "help") == 0) {
        char option[] = "--help";
        return run(3, (char *[]){argv[0], argv[2], option, NULL});
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0) {
        print_help(stdout);
        return CLI_OK;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("trim3r %s, bits epoch %d\n", T3R_VERSION, T3R_BITS_EPOCH);
        return CLI_OK;
    }
    if (strcmp(argv[1], "--commands") == 0) {
        print_commands();
        return CLI_OK;
    }
    const trim3r_command *command = command_named(argv[1]);
    if (command == NULL) {
        return refuse(argv[1]);
    }
    /* argp names the program by argv[0] in its messages */
    static char name[32];
    snprintf(name, sizeof name, "trim3r %s", command->name);
    argv[1] = name;
    cli_set_command(command->name);
    return command->run(argc - 1, argv + 1);
}

/* At every end of the process, argp's of --help as well: a result that could not be printed is not a success. */
static void check_output(void)
{
    errno = 0;
    if (fflush(stdout) != 0 || ferror(stdout)) {
        (void)cli_error(CLI_OK, "standard output: %s", strerror(errno != 0 ? errno : EIO));
        _exit(CLI_BAD_INPUT);
    }
}

/* Opens standard streams that the caller closed, so that no file which is opened later gets their numbers and what is
 * printed. They are opened the other way round: printing to one fails, as it should. */
static void open_closed_streams(void)
{
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; stream++) {
        if (fcntl(stream, F_GETFD) == -1 && errno == EBADF) {
            (void)open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
        }
    }
}

int trim3r_main(int argc, char **argv, const trim3r_extension *added)
{
    open_closed_streams();
    setvbuf(stdout, NULL, _IOLBF, 0); /* rows of long work appear at once, in pipes as well */
    json_watch_memory();
    list_commands(added);
    argp_err_exit_status = CLI_BAD_USAGE;
    signal(SIGXFSZ, SIG_IGN); /* a file too large is an error of write() like any other */
    atexit(check_output);
    int code = check_arguments(argc, argv);
    return code == CLI_OK ? run(argc, argv) : code;
}
