/* SPDX-License-Identifier: Apache-2.0 */
/* Reads the names of topics: a word is a run of letters. */
#include <ctype.h>
#include <string.h>

#include "recording_index.h"

#define MOST_LETTERS 24u

/* Takes the next word at *at in small letters; false at the end. A longer word is cut. */
static bool next_word(const char **at, char word[MOST_LETTERS + 1])
{
    const char *c = *at;
    while (*c != '\0' && !isalpha((unsigned char)*c)) {
        c++;
    }
    size_t letters = 0;
    for (; isalpha((unsigned char)*c); c++) {
        if (letters < MOST_LETTERS) {
            word[letters++] = (char)tolower((unsigned char)*c);
        }
    }
    word[letters] = '\0';
    *at = c;
    return letters > 0;
}

static bool is_among(const char *word, const char *const *words)
{
    while (*words != NULL && strcmp(*words, word) != 0) {
        words++;
    }
    return *words != NULL;
}

/* Returns the place of the topic's last word that is among `words`, counted from 1; 0 if there is none. */
static size_t last_of(const char *topic, const char *const *words)
{
    char word[MOST_LETTERS + 1];
    size_t place = 0, found = 0;
    while (next_word(&topic, word)) {
        place++;
        found = is_among(word, words) ? place : found;
    }
    return found;
}

bool t3r_topic_is_rectified(const char *topic)
{
    static const char *const words[] = {"rect", "rectified", NULL};
    return last_of(topic, words) > 0;
}

bool t3r_topic_is_no_colour(const char *topic)
{
    static const char *const words[] = {
        "annotated",     "annotation",    "annotations", "confidence",   "dbg",       "debug",
        "depth",         "detected",      "detection",   "detections",   "disparity", "edges",
        "features",      "heatmap",       "infra",       "infrared",     "ir",        "keypoints",
        "label",         "labels",        "marker",      "markers",      "mask",      "masks",
        "matches",       "normal",        "normals",     "overlay",      "overlays",  "result",
        "results",       "segmented",     "semantic",    "segmentation", "thermal",   "tracked",
        "visualisation", "visualization", "vis",         "viz",          NULL};
    return last_of(topic, words) > 0;
}

static const char *const depth_words[] = {"depth", NULL};

bool t3r_topic_is_depth(const char *topic)
{
    return last_of(topic, depth_words) > 0 && !t3r_topic_is_no_depth(topic);
}

/* The last word decides: /ir_camera/depth holds depth, /depth/confidence does not. */
bool t3r_topic_is_no_depth(const char *topic)
{
    static const char *const words[] = {
        "amplitude",    "certainty",    "confidence", "cost",    "disparity",   "error",    "gray",  "grey", "infra",
        "infrared",     "intensity",    "ir",         "label",   "labels",      "mask",     "noise", "nir",  "quality",
        "reflectivity", "segmentation", "semantic",   "thermal", "uncertainty", "variance", NULL};
    return last_of(topic, words) > last_of(topic, depth_words);
}

bool t3r_topic_is_no_pose(const char *topic)
{
    static const char *const words[] = {
        "apriltag", "aruco",       "clicked",  "cmd",     "command", "commanded", "desired",   "goal",      "goals",
        "initial",  "initialpose", "marker",   "markers", "object",  "objects",   "obstacle",  "obstacles", "plan",
        "planned",  "reference",   "setpoint", "target",  "targets", "waypoint",  "waypoints", NULL};
    return last_of(topic, words) > 0;
}
