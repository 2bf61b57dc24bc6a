/* path_row in vectors of BYTES disparities. The file that includes this defines TARGET, BYTES, MOST_VECTORS, how its
 * instructions begin (OF) and the functions declared first. The path along the row stays in registers. */
#ifndef T3R_PATH_LANES_H
#define T3R_PATH_LANES_H

typedef uint8_t bytes __attribute__((vector_size(BYTES)));
typedef long long vector __attribute__((vector_size(BYTES), may_alias)); /* as instructions take it */

/* `count` may be 16, or BYTES and more: lanes beyond are 0 when loaded and not stored. */
static inline TARGET bytes load(const uint8_t *from, uint32_t count);
static inline TARGET void store(uint8_t *to, bytes x, uint32_t count);
/* Lanes below `count` of x, else of `other`. */
static inline TARGET bytes held(bytes x, bytes other, uint32_t count);
/* Each lane's neighbour below and above; the ends take theirs of the next vector. */
static inline TARGET bytes below(bytes x, bytes next);
static inline TARGET bytes above(bytes x, bytes next);
/* The least of all lanes, in all lanes. */
static inline TARGET bytes least_of(bytes x);
static inline TARGET uint8_t first_of(bytes x);
/* sums = a + b + c + d, with `add` sums + ...; of two paths c and d are not read. */
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

/* What a path adds to the cost. */
static inline TARGET bytes relaxed(bytes lower, bytes same, bytes upper, bytes least, bytes p1, bytes p2)
{
    return minimum(minimum(same, minimum(lower, upper) + p1) - least, p2);
}

/* count: the disparities; paths: from the row before; along: whether there are sums. */
static inline __attribute__((always_inline)) TARGET void follow(const t3r_path_row *given, const uint32_t count,
                                                                const uint32_t paths, const bool along)
{
    t3r_path_row all = *given, *row = &all; /* a copy: writing bytes changes none of what it holds */
    all.disparities = count;                /* as it is; this says so to compilers */
    const uint32_t width = row->width, vectors = (count + BYTES - 1) / BYTES;
    const size_t pitch = (size_t)count + 1, state = T3R_PATH_STATE_BYTES(width, count);
    const size_t leasts = t3r_path_leasts(width, count);
    const bytes guard = all_of(row->costs->guard), p1 = all_of(row->costs->p1);
    bytes beside[MOST_VECTORS], least = all_of(0);
    for (uint32_t i = 0; i < vectors; i++) {
        beside[i] = held(least, guard, count - i * BYTES);
    }
    const size_t step = row->reverse ? SIZE_MAX : 1;
    size_t x = row->reverse ? width - 1 : 0;
    int32_t luma_behind = row->luma[x];
    for (uint32_t i = 0; i < width; i++, x += step) {
        const uint8_t *cost = row->cost + x * count;
        t3r_path_link links[3];
        bytes leasts_here[3], next_least = all_of(UINT8_MAX), lower = guard;
        _Pragma("GCC unroll 3") for (uint32_t path = 0; path < paths; path++)
        {
            links[path] = t3r_path_link_of(row, path, (uint32_t)x);
            leasts_here[path] = next_least;
        }
        const int32_t change = row->luma[x] - luma_behind;
        const bytes p2 = all_of(row->costs->p2[change < 0 ? -change : change]);
        luma_behind = row->luma[x];
        for (uint32_t n = 0; n < vectors; n++) {
            const uint32_t left = count - n * BYTES; /* disparities from here on */
            const bytes own = load(cost + n * BYTES, left);
            bytes values[T3R_PATH_LINKS];
            _Pragma("GCC unroll 3") for (uint32_t path = 0; path < paths; path++)
            {
                const uint8_t *from = links[path].from + n * BYTES;
                const bytes same = load(from + 1, left);
                const bytes value = held(own + relaxed(load(from, left), same, load(from + 2, left),
                                                       all_of(links[path].least), p1, all_of(links[path].p2)),
                                         guard, left);
                store(row->to + path * state + (x + 1) * pitch + 1 + n * BYTES, value, left);
                leasts_here[path] = minimum(leasts_here[path], value);
                values[path] = value;
            }
            if (along) {
                const bytes same = beside[n], upper = n + 1 < vectors ? beside[n + 1] : guard;
                const bytes value = own + relaxed(below(same, lower), same, above(same, upper), least, p1, p2);
                lower = same;
                beside[n] = held(value, guard, left);
                next_least = minimum(next_least, beside[n]);
                values[paths] = value;
                sum(row->sums + x * count + n * BYTES, values, paths + 1, left, row->reverse);
            }
        }
        least = least_of(next_least);
        _Pragma("GCC unroll 3") for (uint32_t path = 0; path < paths; path++)
        {
            row->to[path * state + leasts + x + 1] = first_of(least_of(leasts_here[path]));
        }
    }
}

#endif
