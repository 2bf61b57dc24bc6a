/* SPDX-License-Identifier: Apache-2.0 */
/* path_row in vectors of BYTES disparities. The including file defines TARGET, BYTES, MOST_VECTORS, the prefix of its
 * instructions (OF) and the functions declared first. The path along the row stays in registers. */
#ifndef T3R_PATH_LANES_H
#define T3R_PATH_LANES_H

typedef uint8_t bytes __attribute__((vector_size(BYTES)));
typedef long long vector __attribute__((vector_size(BYTES), may_alias)); /* type of the instructions' operands */

/* Load and store `count` bytes: 16, or BYTES and more. Other lanes are 0 when loaded and not stored. */
static inline TARGET bytes load(const uint8_t *from, uint32_t count);
static inline TARGET void store(uint8_t *to, bytes x, uint32_t count);
/* Returns lanes below `count` of x, the others of `other`. */
static inline TARGET bytes held(bytes x, bytes other, uint32_t count);
/* Return each lane's neighbour below and above; the ends take theirs from `next`. */
static inline TARGET bytes below(bytes x, bytes next);
static inline TARGET bytes above(bytes x, bytes next);
/* Returns the least of all lanes, in all lanes. */
static inline TARGET bytes least_of(bytes x);
static inline TARGET uint8_t first_of(bytes x);
/* Computes sums = a + b + c + d, or with `add` sums += ...; for two paths c and d are not read. */
static inline TARGET void sum(int16_t *sums, const bytes values[T3R_PATH_LINKS], uint32_t paths, uint32_t count,
                              bool add);

static inline TARGET bytes minimum(bytes a, bytes b)
{
    return (bytes)OF(min_epu8)((vector)a, (vector)b);
}

static inline TARGET bytes all_of(uint8_t x)
{
    return (bytes)OF(set1_epi8)((char)x);
}

/* Returns a path's addition to the cost. */
static inline TARGET bytes relaxed(bytes lower, bytes same, bytes upper, bytes least, bytes p1, bytes p2)
{
    return minimum(minimum(same, minimum(lower, upper) + p1) - least, p2);
}

#define PATH_INLINE static inline __attribute__((always_inline)) TARGET

/* Constants of a row. */
typedef struct path_walk {
    const t3r_path_row *row;
    uint32_t count, paths; /* disparities; paths from the previous row */
    size_t pitch, state;   /* bytes from pixel to pixel, and from path to path */
    bytes guard, p1;
} path_walk;

/* The path along the row at the previous pixel. */
typedef struct path_along {
    bytes beside[MOST_VECTORS], least;
} path_along;

/* Follows a path from the previous row to pixel x: vector n of its disparities. */
PATH_INLINE bytes step_down(const path_walk *walk, uint32_t path, const t3r_path_link *link, size_t x, uint32_t n,
                            bytes own)
{
    const uint32_t left = walk->count - n * BYTES; /* disparities from here on */
    const uint8_t *from = link->from + n * BYTES;
    const bytes same = load(from + 1, left);
    const bytes added =
        relaxed(load(from, left), same, load(from + 2, left), all_of(link->least), walk->p1, all_of(link->p2));
    const bytes value = held(own + added, walk->guard, left);
    store(walk->row->to + path * walk->state + (x + 1) * walk->pitch + 1 + n * BYTES, value, left);
    return value;
}

/* Follows the path along the row; *lower is the previous vector below, then this one. */
PATH_INLINE bytes step_along(const path_walk *walk, path_along *along, uint32_t n, bytes p2, bytes own, bytes *lower)
{
    const uint32_t left = walk->count - n * BYTES;
    const bytes same = along->beside[n], upper = left > BYTES ? along->beside[n + 1] : walk->guard;
    const bytes value = own + relaxed(below(same, *lower), same, above(same, upper), along->least, walk->p1, p2);
    *lower = same;
    along->beside[n] = held(value, walk->guard, left);
    return value;
}

/* Follows all paths to pixel x. along: NULL without sums; p2: for the path along the row. */
PATH_INLINE void step_pixel(const path_walk *walk, size_t x, bytes p2, path_along *along)
{
    const t3r_path_row *row = walk->row;
    const uint32_t vectors = (walk->count + BYTES - 1) / BYTES;
    t3r_path_link links[3];
    bytes leasts[3], least = all_of(UINT8_MAX), lower = walk->guard;
    _Pragma("GCC unroll 3") for (uint32_t path = 0; path < walk->paths; path++)
    {
        links[path] = t3r_path_link_of(row, path, (uint32_t)x);
        leasts[path] = least;
    }
    for (uint32_t n = 0; n < vectors; n++) {
        const uint32_t left = walk->count - n * BYTES;
        const bytes own = load(row->cost + x * walk->count + n * BYTES, left);
        bytes values[T3R_PATH_LINKS];
        _Pragma("GCC unroll 3") for (uint32_t path = 0; path < walk->paths; path++)
        {
            values[path] = step_down(walk, path, &links[path], x, n, own);
            leasts[path] = minimum(leasts[path], values[path]);
        }
        if (along != NULL) {
            values[walk->paths] = step_along(walk, along, n, p2, own, &lower);
            least = minimum(least, along->beside[n]);
            sum(row->sums + x * walk->count + n * BYTES, values, walk->paths + 1, left, row->reverse);
        }
    }
    if (along != NULL) {
        along->least = least_of(least);
    }
    uint8_t *to = row->to + t3r_path_leasts(row->width, walk->count) + x + 1;
    _Pragma("GCC unroll 3") for (uint32_t path = 0; path < walk->paths; path++)
    {
        to[path * walk->state] = first_of(least_of(leasts[path]));
    }
}

/* Follows a row's paths. sums: whether there are sums and a path along the row. */
PATH_INLINE void follow(const t3r_path_row *given, const uint32_t count, const uint32_t paths, const bool sums)
{
    t3r_path_row row = *given; /* a copy, which byte writes cannot change */
    row.disparities = count;   /* unchanged; makes it a constant for compilers */
    const path_walk walk = {
        .row = &row,
        .count = count,
        .paths = paths,
        .pitch = (size_t)count + 1,
        .state = T3R_PATH_STATE_BYTES(row.width, count),
        .guard = all_of(row.costs->guard),
        .p1 = all_of(row.costs->p1),
    };
    path_along along = {.least = all_of(0)};
    for (uint32_t n = 0; n * BYTES < count; n++) {
        along.beside[n] = held(along.least, walk.guard, count - n * BYTES);
    }
    const size_t step = row.reverse ? SIZE_MAX : 1;
    size_t x = row.reverse ? row.width - 1 : 0;
    for (uint32_t i = 0; i < row.width; i++, x += step) {
        const bytes p2 = all_of(t3r_path_p2_along(&row, (uint32_t)x, i));
        step_pixel(&walk, x, p2, sums ? &along : NULL);
    }
}

#endif
