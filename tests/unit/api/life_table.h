/* SPDX-License-Identifier: Apache-2.0 */
/* The life of a runtime as a table: what each call does in each state. test_life.c makes every call in every state, and
 * writes the table of docs/firmware.md. */
#ifndef T3R_TESTS_LIFE_TABLE_H
#define T3R_TESTS_LIFE_TABLE_H

#include "trim3r.h"

typedef enum life_place { EMPTY, PART, VIEWS, FULL, BUILT, ANALYSED, ALONE, PLACES, HERE = PLACES } life_place;

static const char *const place_names[] = {"empty", "part", "views", "full", "scene", "analysis", "scene alone"};

/* The status of a call, and the state after it. */
typedef struct life_outcome {
    t3r_status status;
    life_place after; /* HERE: the same */
} life_outcome;

#define TO(PLACE)                                                                                                      \
    {                                                                                                                  \
        T3R_OK, PLACE                                                                                                  \
    }
#define SAME                                                                                                           \
    {                                                                                                                  \
        T3R_OK, HERE                                                                                                   \
    }
#define NO                                                                                                             \
    {                                                                                                                  \
        T3R_ERR_STATE, HERE                                                                                            \
    }
#define NO_VIEW                                                                                                        \
    {                                                                                                                  \
        T3R_ERR_ARGUMENT, HERE                                                                                         \
    }
#define AFTER(STATUS, PLACE)                                                                                           \
    {                                                                                                                  \
        T3R_ERR_##STATUS, PLACE                                                                                        \
    }

/* X(call, function of test_life.c, outcome in each place), for a runtime of two views as t3r_default_config() makes it.
 * "analysis" exists only with keep_analysis; with "part" there is one view. */
#define CALLS(X)                                                                                                       \
    X("`t3r_add_view()`", add_view, TO(VIEWS), TO(FULL), TO(FULL), NO, NO, NO, NO)                                     \
    X("`t3r_add_rows()`, first rows", first_rows, TO(PART), TO(PART), TO(PART), NO, NO, NO, NO)                        \
    X("`t3r_add_rows()`, last rows", last_rows, NO, TO(FULL), NO, NO, NO, NO, NO)                                      \
    X("`t3r_develop()`", develop, SAME, NO, NO, NO, NO, NO, NO)                                                        \
    X("`t3r_reconstruct()`", reconstruct, NO, TO(BUILT), TO(BUILT), TO(BUILT), TO(BUILT), TO(BUILT), NO)               \
    X("`t3r_rebuild()`", rebuild, NO, NO, NO, NO, NO, TO(BUILT), NO)                                                   \
    X("`t3r_rebuild_least()`", rebuild_least, NO, NO, NO, NO, NO, TO(BUILT), NO)                                       \
    X("`t3r_get_scene()`", get_scene, NO, NO, NO, NO, SAME, NO, SAME)                                                  \
    X("`t3r_render()`", render, NO, NO, NO, NO, TO(ALONE), NO, SAME)                                                   \
    X("`t3r_scene_begin()`", begin, TO(ALONE), TO(ALONE), TO(ALONE), TO(ALONE), TO(ALONE), TO(ALONE), TO(ALONE))       \
    X("`t3r_scene_append()`", append, NO, NO, NO, NO, SAME, NO, SAME)                                                  \
    X("`t3r_view_camera()`", view_camera, NO_VIEW, SAME, SAME, SAME, SAME, SAME, NO_VIEW)                              \
    X("`t3r_view_gain()`", view_gain, NO_VIEW, SAME, SAME, SAME, SAME, SAME, NO_VIEW)                                  \
    X("`t3r_stream_keyframe()`", keyframe, NO, NO, NO, NO, NO, NO, NO)                                                 \
    X("`t3r_stream_again()`", again, NO, NO, NO, NO, NO, NO, NO)                                                       \
    X("`t3r_stream_overlap()`", overlap, NO, NO, NO, NO, NO, NO, NO)                                                   \
    X("`t3r_bind_head()`", bind_head, SAME, SAME, SAME, SAME, SAME, SAME, SAME)                                        \
    X("`t3r_set_hooks()`, `t3r_set_cpu()`", set_hooks, SAME, SAME, SAME, SAME, SAME, SAME, SAME)                       \
    X("`t3r_reset()`", reset, TO(EMPTY), TO(EMPTY), TO(EMPTY), TO(EMPTY), TO(EMPTY), TO(EMPTY), TO(EMPTY))             \
    X("a copy and `t3r_attach()`", attach, SAME, TO(VIEWS), SAME, SAME, SAME, SAME, SAME)                              \
    X("`t3r_add_view()`: no measurement", add_blind, AFTER(NO_DEPTH, EMPTY), AFTER(NO_DEPTH, VIEWS),                   \
      AFTER(NO_DEPTH, VIEWS), NO, NO, NO, NO)                                                                          \
    X("`t3r_add_view()`: the lens shows too little", add_folded, AFTER(CAMERA, EMPTY), AFTER(CAMERA, VIEWS),           \
      AFTER(CAMERA, VIEWS), NO, NO, NO, NO)                                                                            \
    X("`t3r_reconstruct()`: cancelled in the analysis", cancel_reconstruct, NO, AFTER(CANCELLED, VIEWS),               \
      AFTER(CANCELLED, VIEWS), AFTER(CANCELLED, FULL), AFTER(CANCELLED, FULL), AFTER(CANCELLED, FULL), NO)             \
    X("`t3r_rebuild()`: cancelled", cancel_rebuild, NO, NO, NO, NO, NO, AFTER(CANCELLED, ANALYSED), NO)                \
    X("`t3r_render()`: cancelled", cancel_render, NO, NO, NO, NO, AFTER(CANCELLED, ALONE), NO, AFTER(CANCELLED, ALONE))

#define ENUMERATOR(text, function, ...) AT_##function,
enum { CALLS(ENUMERATOR) CALL_COUNT };

#define CELLS(text, function, ...) {__VA_ARGS__},
static const life_outcome plain[CALL_COUNT][PLACES] = {CALLS(CELLS)};

#define TEXT(text, function, ...) text,
static const char *const call_texts[] = {CALLS(TEXT)};

/* Kinds of runtimes, by a setting that changes the table. */
typedef enum life_kind { PLAIN, KEEPING, WARM, STEREO, STREAM, DRAWING, KINDS } life_kind;

static const char *const kind_texts[] = {"", "`keep_analysis`", "`warm`", "depth by stereo", "`stream`", "no `views`"};

/* The outcomes of a kind that are not those above. A stream's map is a scene with its last keyframes. */
static const struct {
    life_kind kind;
    int call;
    life_place in;
    life_outcome outcome;
} others[] = {
    {KEEPING, AT_rebuild, BUILT, TO(BUILT)},
    {KEEPING, AT_rebuild_least, BUILT, TO(BUILT)},
    {KEEPING, AT_render, BUILT, TO(BUILT)},
    {KEEPING, AT_cancel_rebuild, BUILT, AFTER(CANCELLED, ANALYSED)},
    {KEEPING, AT_cancel_render, BUILT, AFTER(CANCELLED, BUILT)},
    {WARM, AT_add_view, FULL, TO(FULL)},
    {WARM, AT_add_view, BUILT, TO(FULL)},
    {WARM, AT_add_view, ALONE, TO(VIEWS)},
    {WARM, AT_first_rows, ALONE, TO(PART)},
    {WARM, AT_render, BUILT, TO(BUILT)},
    {WARM, AT_add_blind, FULL, AFTER(NO_DEPTH, FULL)},
    {WARM, AT_add_blind, BUILT, AFTER(NO_DEPTH, BUILT)},
    {WARM, AT_add_blind, ALONE, AFTER(NO_DEPTH, EMPTY)},
    {WARM, AT_add_folded, FULL, AFTER(CAMERA, FULL)},
    {WARM, AT_add_folded, BUILT, AFTER(CAMERA, FULL)},
    {WARM, AT_add_folded, ALONE, AFTER(CAMERA, EMPTY)},
    {WARM, AT_cancel_render, BUILT, AFTER(CANCELLED, BUILT)},
    {STEREO, AT_reconstruct, PART, NO},
    {STEREO, AT_reconstruct, VIEWS, NO},
    {STEREO, AT_reconstruct, FULL, AFTER(STEREO, FULL)}, /* both views are alike */
    {STEREO, AT_cancel_reconstruct, PART, NO},
    {STEREO, AT_cancel_reconstruct, VIEWS, NO},
    {STEREO, AT_add_blind, EMPTY, TO(VIEWS)},
    {STEREO, AT_add_blind, PART, TO(FULL)},
    {STEREO, AT_add_blind, VIEWS, TO(FULL)},
    {STREAM, AT_keyframe, EMPTY, TO(BUILT)},
    {STREAM, AT_keyframe, BUILT, TO(BUILT)},
    {STREAM, AT_again, BUILT, TO(BUILT)},
    {STREAM, AT_overlap, BUILT, SAME},
    {STREAM, AT_render, BUILT, TO(BUILT)},
    {STREAM, AT_cancel_render, BUILT, AFTER(CANCELLED, BUILT)},
    {STREAM, AT_add_view, EMPTY, NO},
    {STREAM, AT_first_rows, EMPTY, NO},
    {STREAM, AT_add_blind, EMPTY, NO},
    {STREAM, AT_add_folded, EMPTY, NO},
    {STREAM, AT_reconstruct, BUILT, NO},
    {STREAM, AT_cancel_reconstruct, BUILT, NO},
    {STREAM, AT_begin, EMPTY, NO},
    {STREAM, AT_begin, BUILT, NO},
    {STREAM, AT_append, BUILT, NO},
    {DRAWING, AT_add_view, EMPTY, NO},
    {DRAWING, AT_first_rows, EMPTY, NO},
    {DRAWING, AT_add_blind, EMPTY, NO},
    {DRAWING, AT_add_folded, EMPTY, NO},
    {DRAWING, AT_develop, EMPTY, NO},
    {DRAWING, AT_bind_head, EMPTY, NO},
    {DRAWING, AT_bind_head, ALONE, NO},
};

#endif
