/* The options that build, eval, replay and bench share. */
#include "reconstruction/reconstruction.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/option_values.h"
#include "reconstruction/option_names.h"

enum {
    KEY_GAUSSIANS = 256,
    KEY_KEEP,
    KEY_METHOD,
    KEY_MASK_HEAD,
    KEY_ITERATIONS,
    KEY_CONTEXT,
    KEY_AUTO,
    KEY_MAX_LOSS,
    KEY_ALLOCATE,
    KEY_IMPORTANCE,
    KEY_HEAD,
    KEY_WAVELET,
    KEY_LEVELS,
    KEY_CLUSTERS,
    KEY_GAMMA,
    KEY_KEEP_PERCENT,
    KEY_FILL_RADIUS,
    KEY_BRIDGE_RADIUS,
    KEY_FLYING,
    KEY_REDUNDANCY,
    KEY_EXPOSURE,
    KEY_SEED,
    KEY_WORKING,
    KEY_DEPTH,
    KEY_REFINE,
    KEY_ARENA,
    KEY_THREADS,
    KEY_CPU_MASK
};

/* The index of a name in a runtime's list of names. */
#define CHOOSE(type, function)                                                                                         \
    static type choose_##type(struct argp_state *state, const char *option, const char *text)                          \
    {                                                                                                                  \
        for (int i = 0; function((type)i) != NULL; i++) {                                                              \
            if (strcmp(text, function((type)i)) == 0) {                                                                \
                return (type)i;                                                                                        \
            }                                                                                                          \
        }                                                                                                              \
        argp_error(state, "--%s does not know '%s'", option, text);                                                    \
        return (type)0;                                                                                                \
    }
CHOOSE(t3r_allocation, t3r_allocation_name)
CHOOSE(t3r_wavelet, t3r_wavelet_name)

static const struct argp_option settings[] = {
    {NULL, 0, NULL, 0, "Settings:", 20},
    {"auto", KEY_AUTO, NULL, 0,
     "no more Gaussians than the scene needs: as few as are predicted to stay within --max-loss, the budget at most "
     "(all valid points)",
     0},
    {"max-loss", KEY_MAX_LOSS, "DB", 0, "of --auto: decibels of new views against all valid points, 0.01..10 (0.5)", 0},
    {"allocate", KEY_ALLOCATE, "MODE", 0,
     "how the budget is spread: density (default), paper, pixel, uniform, random, given", 0},
    {"importance", KEY_IMPORTANCE, "PNG,PNG,...", 0,
     "of --allocate given, which keeps the brightest points: a grey picture a context view at the working size, in "
     "their order, or a folder with <frame>.png; 16 bits as they are, 8 bits spread evenly within a level",
     0},
    {"head", KEY_HEAD, "HEAD", 0,
     "the networks nano, small (default), base, or one in a FILE.t3w; without weights: analytic, moment, none", 0},
    {"wavelet", KEY_WAVELET, "NAME", 0, "db2 (default), haar, cdf53", 0},
    {"levels", KEY_LEVELS, "N", 0, "wavelet levels, 1..5 (2)", 0},
    {"clusters", KEY_CLUSTERS, "K", 0, "SuperClusters, 1..512 (300)", 0},
    {"gamma", KEY_GAMMA, "G", 0, "exponent of texture in the density, 0..2 (0.7)", 0},
    {"keep-percent", KEY_KEEP_PERCENT, "N", 0, "percent that a trimmed SuperCluster keeps with --allocate paper (10)",
     0},
    {"fill-radius", KEY_FILL_RADIUS, "N", 0, "depth holes bracketed within N pixels are filled, 0..8 (4)", 0},
    {"bridge-radius", KEY_BRIDGE_RADIUS, "N", 0,
     "wider ones too, where no other view measured the surface, 0..255 (64)", 0},
    {"flying", KEY_FLYING, "on|off", 0,
     "points between surfaces, or in front of what another view measured, come last (on)", 0},
    {"redundancy", KEY_REDUNDANCY, "on|off", 0,
     "small budgets pass over points whose surface another view has as finely (on)", 0},
    {"exposure", KEY_EXPOSURE, "on|off", 0, "colours of all views are brought to their mean exposure (on)", 0},
    {"seed", KEY_SEED, "N", 0, "of the K-means seeding and of --allocate random (1)", 0},
    {"working", KEY_WORKING, "WxH", 0, "working size of the context views (the recording's)", 0},
    {"depth", KEY_DEPTH, "SOURCE", 0,
     "sensor (default), or stereo: made of the colours of two and more posed frames, whether they have depth or not",
     0},
    {"refine", KEY_REFINE, "N", 0, "refinement passes on the context views, 0..16 (4)", 0},
    {NULL, 0, NULL, 0, "What must not change a bit:", 30},
    {"arena", KEY_ARENA, "BYTES|min|full", 0, "memory of the runtime (full)", 0},
    {"threads", KEY_THREADS, "N|all", 0, "1..16, or `all` processors (1)", 0},
    {"cpu-mask", KEY_CPU_MASK, "MASK", 0,
     "of the processor's vector extensions use these alone: all (default), none, names as avx2,vnni, or a number", 0},
    {0},
};

void reconstruction_parse_arena(struct argp_state *state, const char *text, reconstruction_options *o)
{
    if (strcmp(text, "full") == 0) {
        o->arena = ARENA_FULL;
    } else if (strcmp(text, "min") == 0) {
        o->arena = ARENA_MIN;
    } else {
        char *end = NULL;
        size_t digits = strspn(text, "0123456789");
        uint64_t bytes = strtoull(text, &end, 10);
        if (digits == 0 || digits > 15 || *end != '\0') {
            argp_error(state, "--arena takes a number of bytes, min or full, not '%s'", text);
        }
        o->arena = ARENA_BYTES;
        o->arena_bytes = bytes;
    }
}

static void parse_gamma(struct argp_state *state, const char *text, reconstruction_options *o)
{
    char *end = NULL;
    size_t length = strspn(text, "0123456789.");
    double gamma = strtod(text, &end);
    if (length == 0 || end != text + length || *end != '\0' || gamma > 2) {
        argp_error(state, "--gamma takes a number 0..2, not '%s'", text);
        return;
    }
    o->gamma_q8 = (uint32_t)(gamma * 256 + 0.5);
}

static void parse_max_loss(struct argp_state *state, const char *text, reconstruction_options *o)
{
    char *end = NULL;
    size_t length = strspn(text, "0123456789.");
    double loss = strtod(text, &end);
    if (length == 0 || end != text + length || *end != '\0' || loss < 0.01 || loss > 10) {
        argp_error(state, "--max-loss takes decibels 0.01..10, not '%s'", text);
        return;
    }
    o->max_loss = loss;
}

static void check_settings(struct argp_state *state, reconstruction_options *o)
{
    if ((o->allocation == T3R_ALLOCATE_GIVEN) != (o->importance != NULL)) {
        argp_error(state, "--allocate given and --importance belong together");
    }
    if (o->points_of != NULL && o->depth != T3R_DEPTH_SENSOR) {
        argp_error(state, "--depth belongs to a recording's own points, not to --prune");
    }
    if (o->max_loss > 0 && !o->automatic) {
        argp_error(state, "--max-loss belongs to --auto");
    }
    if (!o->automatic) {
        return;
    }
    if (o->allocation == T3R_ALLOCATE_GIVEN) {
        argp_error(state, "--auto predicts nothing for --allocate given");
    }
    if (o->refine == 0) {
        argp_error(state, "--auto measures where refinement does: it needs --refine 1 or more");
    }
    if (o->max_loss <= 0) {
        o->max_loss = RECONSTRUCTION_MAX_LOSS;
    }
}

static uint32_t parse_switch(struct argp_state *state, const char *option, const char *text)
{
    if (strcmp(text, "on") != 0 && strcmp(text, "off") != 0) {
        argp_error(state, "--%s takes on or off, not '%s'", option, text);
    }
    return strcmp(text, "on") == 0;
}

static error_t parse_setting(int key, char *arg, struct argp_state *state)
{
    reconstruction_options *o = state->input;
    switch (key) {
    case KEY_ALLOCATE:
        o->allocation = choose_t3r_allocation(state, "allocate", arg);
        return 0;
    case KEY_IMPORTANCE:
        o->importance = arg;
        return 0;
    case KEY_HEAD:
        o->head = option_head(state, "head", arg);
        return 0;
    case KEY_WAVELET:
        o->wavelet = choose_t3r_wavelet(state, "wavelet", arg);
        return 0;
    case KEY_LEVELS:
        o->wavelet_levels = option_number(state, "levels", arg, 1, T3R_MAX_LEVELS);
        return 0;
    case KEY_CLUSTERS:
        o->clusters = option_number(state, "clusters", arg, 1, T3R_MAX_CLUSTERS);
        return 0;
    case KEY_GAMMA:
        parse_gamma(state, arg, o);
        return 0;
    case KEY_KEEP_PERCENT:
        o->paper_keep_percent = option_number(state, "keep-percent", arg, 0, 100);
        return 0;
    case KEY_FILL_RADIUS:
        o->fill_radius = option_number(state, "fill-radius", arg, 0, 8);
        return 0;
    case KEY_BRIDGE_RADIUS:
        o->bridge_radius = option_number(state, "bridge-radius", arg, 0, 255);
        return 0;
    case KEY_FLYING:
        o->flying = parse_switch(state, "flying", arg);
        return 0;
    case KEY_REDUNDANCY:
        o->redundancy = parse_switch(state, "redundancy", arg);
        return 0;
    case KEY_EXPOSURE:
        o->exposure = parse_switch(state, "exposure", arg);
        return 0;
    case KEY_SEED:
        o->seed = option_number(state, "seed", arg, 0, UINT32_MAX);
        return 0;
    case KEY_WORKING:
        option_size(state, "working", arg, T3R_MIN_SIDE, &o->width, &o->height);
        return 0;
    case KEY_DEPTH:
        o->depth = option_depth(state, "depth", arg);
        return 0;
    case KEY_REFINE:
        o->refine = option_number(state, "refine", arg, 0, T3R_MAX_REFINEMENTS);
        return 0;
    case KEY_ARENA:
        reconstruction_parse_arena(state, arg, o);
        return 0;
    case KEY_THREADS:
        o->threads = option_threads(state, "threads", arg);
        return 0;
    case KEY_CPU_MASK:
        o->cpu = option_cpu_mask(state, arg);
        return 0;
    case KEY_AUTO:
        o->automatic = true;
        return 0;
    case KEY_MAX_LOSS:
        parse_max_loss(state, arg, o);
        return 0;
    case ARGP_KEY_END:
        check_settings(state, o);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

const struct argp reconstruction_settings_argp = {.options = settings, .parser = parse_setting};

static const struct argp_option budget[] = {
    {NULL, 0, NULL, 0, "Views and budget:", 10},
    {"context", KEY_CONTEXT, "A,B,...", 0, "frames that the scene is made of, 1..16 (the first two)", 0},
    {"gaussians", KEY_GAUSSIANS, "Z", 0, "exactly Z Gaussians, or all valid points where there are fewer", 0},
    {"keep", KEY_KEEP, "P%", 0, "as many as P percent of the valid points, rounded half up", 0},
    {"method", KEY_METHOD, "METHOD", 0,
     "trim3r (default); the rivals random, eagles, lightgaussian, pup, efficientgs; behind any of them +finetune, or "
     "+head: their points for our head",
     0},
    {"mask-head", KEY_MASK_HEAD, "HEAD", 0, "of a rival with +head: the head whose unpruned scene it ranks (--head's)",
     0},
    {"finetune-iterations", KEY_ITERATIONS, "N", 0, "of the methods with +finetune, 1..100000 (200)", 0},
    {0},
};

static error_t parse_budget(int key, char *arg, struct argp_state *state)
{
    reconstruction_options *o = state->input;
    uint32_t count;
    switch (key) {
    case KEY_CONTEXT:
        option_frames(state, "context", arg, o->context, &o->context_count);
        return 0;
    case KEY_GAUSSIANS:
        o->gaussians = option_number(state, "gaussians", arg, 1, T3R_MAX_GAUSSIANS);
        return 0;
    case KEY_KEEP:
        option_percents(state, "keep", arg, &o->keep_percent, 1, &count);
        return 0;
    case KEY_METHOD:
        o->method = method_named(arg, strlen(arg));
        if (o->method == METHOD_COUNT) {
            argp_error(state, "--method does not know '%s'; there are %s", arg, METHOD_NAMES);
        }
        return 0;
    case KEY_MASK_HEAD:
        o->mask_head = option_head(state, "mask-head", arg);
        return 0;
    case KEY_ITERATIONS:
        o->finetune_iterations = option_number(state, "finetune-iterations", arg, 1, METHOD_ITERATIONS_MOST);
        return 0;
    case ARGP_KEY_END:
        if (o->gaussians != 0 && o->keep_percent > 0) {
            argp_error(state, "--gaussians and --keep exclude each other");
        }
        if (o->mask_head != NULL && !method_ranks_for_head(o->method)) {
            argp_error(state, "--mask-head belongs to a rival with +head");
        }
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

const struct argp reconstruction_budget_argp = {.options = budget, .parser = parse_budget};
