/* SPDX-License-Identifier: Apache-2.0 */
/* JSON that is written: whole, or not at all when memory runs out. */
#ifndef TRIM3R_TOOLS_JSON_OUTPUT_H
#define TRIM3R_TOOLS_JSON_OUTPUT_H

#include <stdint.h>

#include <cjson/cJSON.h>

#define HASH_TEXT_BYTES 17

/* Writes 16 lower-case hexadecimal digits. */
void hash_text(uint64_t hash, char text[HASH_TEXT_BYTES]);
/* Parses 16 hexadecimal digits, optionally preceded by "0x". Returns 0, or -1 for other texts. */
int hash_parse(const char *text, uint64_t *hash);

void json_add_hash(cJSON *object, const char *key, uint64_t hash);
/* Adds an integer exactly, also beyond 2^53, where a double would round. */
void json_add_integer(cJSON *object, const char *key, int64_t value);
void json_add_integers(cJSON *object, const char *key, const uint32_t *values, uint32_t count);
/* Begins to watch cJSON's allocations: it leaves out what it has no memory for, without a word. */
void json_watch_memory(void);
/* Returns the object's text on one line, and frees the object; free() the text. NULL: an allocation failed since
 * json_watch_memory(). */
char *json_text(cJSON *object);
/* Prints the one object of a command with --json, and frees it; ends the process if memory ran out. */
void json_print(cJSON *object);

#endif
