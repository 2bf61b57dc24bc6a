/* Reports the hashes of a replay as text and JSON. */
#ifndef TRIM3R_TOOLS_HASH_REPORT_H
#define TRIM3R_TOOLS_HASH_REPORT_H

#include <stdint.h>

#include <cjson/cJSON.h>

#include "reconstruction/reconstruction.h"

/* Prints a line on stdout for each stage with a hash, then one for the hash of the whole. */
void hash_report_print(const reconstruction *r, uint64_t whole);
/* Adds the field "stages": the hash of each stage that has one, by name. */
void hash_report_add_stages(cJSON *object, const reconstruction *r);

#endif
