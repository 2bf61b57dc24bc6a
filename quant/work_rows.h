/* What a head's activations take when it runs row by row: of each layer only the rows that its readers still need. */
#ifndef T3R_QUANT_WORK_ROWS_H
#define T3R_QUANT_WORK_ROWS_H

#include "head_graph.h"

/* rows[n]: the most rows of layer n (0: of the features) that are held at once while a view of `height` rows goes
 * through, rows being made as late as a reader allows. A point layer holds one pixel: its rows are 0. */
void head_work_rows(const head_graph *graph, uint32_t height, uint32_t rows[T3R_MAX_LAYERS + 1]);

/* Bytes of those rows for a view `width` pixels wide; of a point layer, of its outputs at one pixel. */
size_t head_work_bytes(const head_graph *graph, uint32_t n, uint32_t rows, uint32_t width, uint32_t activation_bits);

#endif
