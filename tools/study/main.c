/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r with its study commands, which measure it against other methods and trained its heads. */
#include <stddef.h>

#include "study/commands/commands.h"
#include "trim3r/front.h"

static const trim3r_command commands[] = {
    {"build", command_build_by_method, NULL},
    {"eval", command_eval_methods, NULL},
    {"chart", command_chart, "plot scores against time and bytes, as a picture or a report"},
    {"stress", command_stress, "measure each method under noise, wrong poses and hard scenes"},
    {"trouble", command_trouble, "put a trouble of a moving camera into a recording"},
    {"quantize", command_quantize, "turn a trained head into integers: a weight file or a C source"},
};

static const trim3r_extension study = {
    .heading = "Study:", .commands = commands, .count = sizeof commands / sizeof commands[0]};

int main(int argc, char **argv)
{
    return trim3r_main(argc, argv, &study);
}
