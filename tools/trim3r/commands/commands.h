/* SPDX-License-Identifier: Apache-2.0 */
/* The subcommands of trim3r: each is one file, commands/NAME.c, and parses its own arguments with argp.
 * argv[0] is the subcommand's name; the result is the exit status (cli.h). */
#ifndef TRIM3R_TOOLS_COMMANDS_H
#define TRIM3R_TOOLS_COMMANDS_H

int command_scene(int argc, char **argv);
int command_import(int argc, char **argv);
int command_capture(int argc, char **argv);
int command_info(int argc, char **argv);
int command_build(int argc, char **argv);
int command_convert(int argc, char **argv);
int command_render(int argc, char **argv);
int command_view(int argc, char **argv);
int command_eval(int argc, char **argv);
int command_replay(int argc, char **argv);
int command_diff(int argc, char **argv);
int command_doctor(int argc, char **argv);
int command_plan(int argc, char **argv);
int command_bench(int argc, char **argv);
int command_room(int argc, char **argv);
int command_head_info(int argc, char **argv);
int command_completion(int argc, char **argv);

#endif
