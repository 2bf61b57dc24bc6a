/* Options by which import reads a bag: names of its topics and frames. */
#ifndef TRIM3R_TOOLS_BAG_OPTIONS_H
#define TRIM3R_TOOLS_BAG_OPTIONS_H

#include <argp.h>

#include "import/bags/bag_frames.h"
#include "recording/recording.h"

typedef struct bag_options {
    t3r_recording_choice topics;
    bag_frames_options frames;
    const char *given; /* a topic or frame option that was given, else NULL */
} bag_options;

#define BAG_GROUP 10 /* group of these options in --help */

/* Each parent's parser passes a bag_options * in state->child_inputs[]. */
extern const struct argp bag_argp;

#endif
