/* NumPy arrays in files: a .npz, which is a zip archive of NAME.npy, stored or deflated, or one .npy; through libzip.
 * Headers are read first, numbers only on request. */
#ifndef TRIM3R_TOOLS_ARRAY_FILE_H
#define TRIM3R_TOOLS_ARRAY_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "import/pointmaps/npy.h"

typedef struct array_file array_file;

/* Opens a file; its contents decide which of the two it is. Returns NULL with "path: what" in error[] on failure. */
array_file *array_file_open(const char *path, char *error, size_t error_bytes);
/* The same for memory, which must outlive it; the reason has no path. */
array_file *array_file_parse(const uint8_t *bytes, size_t count, char *error, size_t error_bytes);
void array_file_close(array_file *file);
/* Whether the file is a single .npy, whose array has no name. */
bool array_file_is_lone(const array_file *file);

/* An array of the file. The file must outlive it. */
typedef struct array_stream array_stream;

/* Looks for the array NAME (any name for a single .npy) and reads its header. Returns 1; 0 when there is none of that
 * name; -1 with what is wrong in error[], also when the arrays found so far decompress to more than the file
 * justifies. */
int array_file_find(array_file *file, const char *name, array_stream **out, char *error, size_t error_bytes);
void array_stream_close(array_stream *stream);
const npy_array *array_stream_header(const array_stream *stream);

/* Read numbers first ... first + count - 1 of the array. Reading forward is cheap: numbers in between are decompressed
 * and dropped. After the last number the archive's CRC is compared. Return NULL, or what is wrong; floats need an array
 * of float32. */
const char *array_stream_floats(array_stream *stream, size_t first, size_t count, float *out);
const char *array_stream_doubles(array_stream *stream, size_t first, size_t count, double *out);

#endif
