/* SPDX-License-Identifier: Apache-2.0 */
/* One run of the runtime on a recording: what build, eval, replay and bench share.
 *
 * Chosen frames go into an arena of the requested size, the hooks are set, the scene is built; the caller then renders,
 * changes the budget or writes files through `runtime`, and closes. The same struct holds a scene from a file.
 * Functions here report on stderr and return an exit status of cli.h. */
#ifndef TRIM3R_TOOLS_RECONSTRUCTION_H
#define TRIM3R_TOOLS_RECONSTRUCTION_H

#include <argp.h>
#include <stdbool.h>
#include <stdint.h>

#include "cli/options/processor_options.h"
#include "posing/poses_source.h"
#include "reconstruction/chosen_head.h"
#include "reconstruction/finetune_options.h"
#include "reconstruction/measured_loss.h"
#include "reconstruction/stage_times.h"
#include "recording/recording.h"
#include "scene/scene_file.h"
#include "scene/seen_gaussian.h"
#include "trim3r.h"
#include "trim3r_host.h"

typedef enum arena_choice { ARENA_FULL, ARENA_MIN, ARENA_BYTES } arena_choice;

/* The source of the context frames. */
typedef enum context_kind {
    CONTEXT_LISTED, /* `context`, or the first two */
    CONTEXT_ALL,    /* all frames of the recording */
    CONTEXT_AUTO    /* those that context_choose() chooses */
} context_kind;

#define RECONSTRUCTION_MAX_LOSS 0.5 /* dB, for --auto */

/* Settings from the command line. reconstruction_defaults() fills every field. */
typedef struct reconstruction_options {
    /* Configuration of the runtime: settings.h has the settings of a user. Views, head and budget are set by the build;
     * a width of 0 is the first context frame's size, a render_width of 0 the working size. */
    t3r_config config;
    uint32_t context[T3R_MAX_VIEWS]; /* frame indices of the context views */
    uint32_t context_count;          /* 0 = the first two frames, or as context_kind says */
    context_kind context_kind;       /* others than CONTEXT_LISTED are replaced before a build: context_frames.h */
    uint32_t context_views;          /* for `eval --views`: frames of a case; 2 = the triplet's own */
    poses_source poses;              /* set by callers: source of the context views' poses */
    uint32_t gaussians;              /* budget as a count; 0 = keep_percent decides */
    double keep_percent;             /* budget as percent of the valid points, (0, 100]; 0 = not given */
    bool automatic;                  /* fewer than the budget if they lose less than max_loss */
    double max_loss;                 /* dB, relative to all points; 0 unless automatic */
    double min_psnr;                 /* dB of the context views: the fewest that reach it; 0 = exactly the budget */
    const struct method *method;     /* for callers that build by several methods (method.h); NULL = none given */
    finetune_options finetune;       /* for methods that fine-tune */
    const char
        *importance; /* for the allocation `given`: a text for importance_pictures_read(); NULL = the planes below */
    const uint16_t *const *importance_planes; /* one per context view at the working size, rows without gaps */
    const char *head;                         /* a text accepted by chosen_head_is_one() */
    const char *mask_head; /* likewise, for methods that rank a scene of another head; NULL = `head` */
    t3r_ablation ablation; /* part removed from the method */
    bool hide_mask;        /* the network sees a mask of all pixels: hidden_mask.h */
    const char *points_of; /* a scene whose Gaussians give the depth instead (scene_frames.h), and the points that
                              percentages refer to; NULL = none */
    int scene_flags;       /* for scene_file_read() of both files */
    const char *scene;     /* set by callers: a scene file to evaluate instead of a build; NULL = none */
    bool hash;             /* collect the stages' hashes */
    arena_choice arena;
    uint64_t arena_bytes; /* for ARENA_BYTES */
    processor_options processor;
} reconstruction_options;

void reconstruction_defaults(reconstruction_options *options);

/* Whether the budget is only the most, and the build chooses the number of Gaussians. */
static inline bool reconstruction_chooses(const reconstruction_options *options)
{
    return options->automatic || options->min_psnr > 0;
}

/* argp children; each parent's parser passes a reconstruction_options * in state->child_inputs[]. `settings`: --auto
 * --allocate --head --wavelet ... --arena --threads; `budget`: --context --gaussians --keep. */
extern const struct argp reconstruction_settings_argp;
extern const struct argp reconstruction_budget_argp;
extern const struct argp reconstruction_argp; /* both */

/* Parses the value of --arena, for parsers without the children; reports a usage error if it is none. */
void reconstruction_parse_arena(struct argp_state *state, const char *text, reconstruction_options *options);
/* Parses the value of --context likewise. */
void reconstruction_parse_context(struct argp_state *state, const char *text, reconstruction_options *options);
/* Whether the options say of which frames the scene is made. */
bool reconstruction_names_context(const reconstruction_options *options);

typedef struct reconstruction {
    t3r_config config;
    chosen_head head;
    t3r_runtime *runtime;
    void *arena;
    size_t arena_bytes;
    t3r_threads *threads;
    t3r_scene scene;
    scene_file loaded; /* scene taken by reconstruction_load(); else all zero */
    bool is_seen;      /* the arena has the loaded scene as a camera sees it: */
    seen_from seen;    /* that of the last view */
    uint32_t context[T3R_MAX_VIEWS];
    uint32_t context_count;
    uint32_t valid_points;    /* pixels of the context views with a depth before filling, working size */
    uint32_t pruned;          /* Gaussians of the scene that gives the points; 0 = none */
    uint32_t requested;       /* the requested budget, without max_loss; more than valid_points when all are used */
    double add_views_seconds; /* time of the image stage */
    double build_seconds;     /* time of t3r_reconstruct() */
    t3r_least least;          /* for min_psnr; else all zero */
    uint8_t *shown[T3R_MAX_VIEWS];        /* for min_psnr: lens_masks.h */
    measured_loss loss;                   /* for max_loss; else all zero */
    stage_times stages;                   /* of both, if hashes are collected */
    double give_up_at;                    /* cli_now() at which the run is cancelled; 0 = never */
    uint64_t stage_hash[T3R_STAGE_COUNT]; /* the reports of a stage that reports several times are chained */
    bool stage_hashed[T3R_STAGE_COUNT];
    bool uncounted;               /* hashes reported now are left out */
    char reason[T3R_ERROR_BYTES]; /* of the error of reconstruction_make() */
} reconstruction;

/* The report on a build, by any method. */
typedef struct reconstruction_account {
    char head[16], bits[8], crc[9]; /* as in chosen_head */
    uint32_t width, height;         /* working size */
    uint32_t context[T3R_MAX_VIEWS];
    uint32_t context_count;
    bool has_cameras;                    /* false for a scene made elsewhere */
    t3r_camera camera[T3R_MAX_VIEWS];    /* of the context views, as the build used them: `align` may have moved them */
    uint16_t gain_q14[T3R_MAX_VIEWS][3]; /* of their r g b, to the exposure of the scene */
    double unit;                         /* of the scene, in world units */
    uint32_t valid_points, requested;
    size_t arena_bytes;
    double seconds; /* from recorded frames to the scene */
} reconstruction_account;

reconstruction_account reconstruction_account_of(const reconstruction *r);
/* Warns on stderr when more Gaussians were requested than the `count` that the views give. */
void reconstruction_warn_of_budget(const reconstruction_options *options, uint32_t requested, uint32_t count);

/* Returns the budget for a share of the points: rounded half up, at least 1. */
uint32_t reconstruction_budget(uint32_t valid_points, double keep_percent);

/* Builds the scene. It must be closed only after CLI_OK. */
int reconstruction_build(reconstruction *r, const t3r_recording *recording, const char *path,
                         const reconstruction_options *options);

/* Prepares an arena for a stream with `keyframes` live keyframes (t3r_stream_keyframe()), with no frame added yet. A
 * budget in percent refers to the valid points of the context frames, which have no other use. */
int reconstruction_stream(reconstruction *r, const t3r_recording *recording, const char *path,
                          const reconstruction_options *options, uint32_t keyframes);
/* The same without a recording: frames have that working size, and the options give the budget as a count. */
int reconstruction_live_stream(reconstruction *r, uint32_t width, uint32_t height,
                               const reconstruction_options *options, uint32_t keyframes);
/* Binds the runtime again, without hooks, to an arena whose bytes were restored: t3r_attach(). */
int reconstruction_attach(reconstruction *r, const reconstruction_options *options);
/* Configures a build without a recording (live_build.h): the options' configuration for the working size in r->config,
 * r->context_count views and r->head. The next function sets the budget. */
void reconstruction_configure(reconstruction *r, const reconstruction_options *options);
/* Allocates an arena of the size that the options request for r->config, and starts their threads. */
int reconstruction_allocate(reconstruction *r, const reconstruction_options *options);
/* The same, with the runtime initialised in it and hooks bound, among them a progress line. */
int reconstruction_open_arena(reconstruction *r, const reconstruction_options *options);
/* Sets the budget that the options request, relative to r->valid_points. */
void reconstruction_request(reconstruction *r, const reconstruction_options *options);
/* Builds from the views added to r->scene; `planes` are the importance for the allocation `given`, else NULL. */
t3r_status reconstruction_make(reconstruction *r, const reconstruction_options *options, const uint16_t *const *planes);
/* Explains its error; `what` is put before the reason. */
int reconstruction_make_error(const reconstruction *r, t3r_status status, const char *what);
/* Returns hooks that collect hashes into `r` and use its threads, without a progress line. */
t3r_hooks reconstruction_hooks(reconstruction *r, const reconstruction_options *options);

/* Fills an arena that only renders with a scene from a file; targets up to width x height. Only the options for arena,
 * threads and hash are read. `r` takes ownership of the scene in every case: *scene is left empty. */
int reconstruction_load(reconstruction *r, scene_file *scene, uint32_t width, uint32_t height,
                        const reconstruction_options *options);
/* Gives a loaded scene the colours, opacities and frame that a camera sees; later t3r_render() calls draw them. Scenes
 * that look the same from everywhere are unchanged. */
int reconstruction_look_from(reconstruction *r, const t3r_camera *camera, uint32_t width, uint32_t height);
/* Returns a depth that t3r_render() drew, in world units. */
double reconstruction_depth(const reconstruction *r, uint32_t depth_q20);

void reconstruction_close(reconstruction *r);

/* Returns a hash of the collected stages in order, each as its number and its hash: one hash for the whole run. */
uint64_t reconstruction_hash(const reconstruction *r);
/* Clears the hashes collected so far (before another render, for example). */
void reconstruction_clear_hashes(reconstruction *r);

/* Returns the camera for the same view on another pixel grid, without distortion: targets are pinhole. Integers
 * only. */
t3r_camera reconstruction_camera(const t3r_camera *camera, uint32_t from_width, uint32_t from_height, uint32_t width,
                                 uint32_t height);

#endif
