/* NumPy's arrays in files: a .npz, which is a zip archive of NAME.npy, stored or deflated, or one .npy; through libzip.
 * Headers are read first, numbers only where they are asked for. */
#ifndef TRIM3R_TOOLS_ARRAY_FILE_H
#define TRIM3R_TOOLS_ARRAY_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "import/pointmaps/npy.h"

typedef struct array_file array_file;

/* Which of the two is told by what it holds. NULL with "path: what" in error[]. */
array_file *array_file_open(const char *path, char *error, size_t error_bytes);
/* The same from memory, which must outlive it; "what" alone. */
array_file *array_file_parse(const uint8_t *bytes, size_t count, char *error, size_t error_bytes);
void array_file_close(array_file *file);
/* Whether it is one .npy, whose array has no name. */
bool array_file_is_lone(const array_file *file);

/* An array of the file, which must outlive it. */
typedef struct array_stream array_stream;

/* Looks for NAME (any, where the array is a lone one) and reads its header. 1; 0 when there is none of that name; -1
 * with what is wrong in error[]: also where the arrays found so far unpack to more than the file justifies. */
int array_file_find(array_file *file, const char *name, array_stream **out, char *error, size_t error_bytes);
void array_stream_close(array_stream *stream);
const npy_array *array_stream_header(const array_stream *stream);

/* Numbers first ... first + count - 1 of the array. Forward is cheap: what is passed over is unpacked and dropped;
 * behind the last number the archive's CRC is compared. NULL, or what is wrong; floats only of an array of float32. */
const char *array_stream_floats(array_stream *stream, size_t first, size_t count, float *out);
const char *array_stream_doubles(array_stream *stream, size_t first, size_t count, double *out);

#endif
