/* SPDX-License-Identifier: Apache-2.0 */
/* The commands of the study, like those in trim3r/commands/commands.h. Two replace a command of the product and
 * extend its options. */
#ifndef TRIM3R_TOOLS_STUDY_COMMANDS_H
#define TRIM3R_TOOLS_STUDY_COMMANDS_H

int command_build_by_method(int argc, char **argv);
int command_eval_methods(int argc, char **argv);
int command_chart(int argc, char **argv);
int command_stress(int argc, char **argv);
int command_trouble(int argc, char **argv);
int command_quantize(int argc, char **argv);

#endif
