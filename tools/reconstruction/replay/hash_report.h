/* What a replay tells of its hashes, as text and as JSON. */
#ifndef TRIM3R_TOOLS_HASH_REPORT_H
#define TRIM3R_TOOLS_HASH_REPORT_H

#include <stdint.h>

#include <cjson/cJSON.h>

#include "reconstruction/reconstruction.h"

/* A line on stdout for each stage that has a hash, then one for the hash of the whole. */
void hash_report_print(const reconstruction *r, uint64_t whole);
/* The field "stages" of the object: the hash of each stage that has one, by its name. */
void hash_report_add_stages(cJSON *object, const reconstruction *r);

#endif
