/* SPDX-License-Identifier: Apache-2.0 */
/* Names and sentences for the command line and tables. */
#include "features.h"
#include "trim3r.h"

/* Checks that a table is exactly as long as its enumeration. */
#define EVERY_NAME(names, count)                                                                                       \
    _Static_assert(sizeof(names) / sizeof *(names) == (count), "as many names as enumerators")

static const char *pick(const char *const *names, uint32_t count, uint32_t index)
{
    return index < count ? names[index] : NULL;
}

const char *t3r_stage_name(t3r_stage stage)
{
    static const char *const names[] = {
        [T3R_STAGE_IMAGE] = "image",
        [T3R_STAGE_DEPTH] = "depth",
        [T3R_STAGE_POINTMAP] = "pointmap",
        [T3R_STAGE_WAVELET] = "wavelet",
        [T3R_STAGE_SUPERCLUSTERS] = "superclusters",
        [T3R_STAGE_BUDGET] = "budget",
        [T3R_STAGE_HEAD] = "head",
        [T3R_STAGE_REFINE] = "refine",
        [T3R_STAGE_RASTER] = "raster",
    };
    EVERY_NAME(names, T3R_STAGE_COUNT);
    return pick(names, T3R_STAGE_COUNT, (uint32_t)stage);
}

#define ALLOCATION_NAME(NAME, name) [T3R_ALLOCATE_##NAME] = #name,

const char *t3r_allocation_name(t3r_allocation allocation)
{
    static const char *const names[] = {T3R_ALLOCATIONS(ALLOCATION_NAME)};
    EVERY_NAME(names, T3R_ALLOCATE_COUNT);
    return pick(names, T3R_ALLOCATE_COUNT, (uint32_t)allocation);
}

#define DEPTH_NAME(NAME, name) [T3R_DEPTH_##NAME] = #name,

const char *t3r_depth_name(t3r_depth depth)
{
    static const char *const names[] = {T3R_DEPTHS(DEPTH_NAME)};
    EVERY_NAME(names, T3R_DEPTH_COUNT);
    return pick(names, T3R_DEPTH_COUNT, (uint32_t)depth);
}

const char *t3r_refusal_name(t3r_refusal refusal)
{
    static const char *const names[] = {
        [T3R_REFUSAL_NONE] = "none",
        [T3R_REFUSAL_NO_DEPTH] = "no depth",
        [T3R_REFUSAL_FAR] = "far",
        [T3R_REFUSAL_DARK] = "dark",
        [T3R_REFUSAL_BRIGHT] = "bright",
        [T3R_REFUSAL_EXPOSURE] = "exposure",
        [T3R_REFUSAL_BLURRED] = "blurred",
        [T3R_REFUSAL_COVERED] = "covered",
        [T3R_REFUSAL_CONTRADICTS] = "contradicts",
    };
    EVERY_NAME(names, T3R_REFUSAL_COUNT);
    return pick(names, T3R_REFUSAL_COUNT, (uint32_t)refusal);
}

const char *t3r_preset_name(t3r_preset preset)
{
    static const char *const names[] = {
        [T3R_PRESET_FAST] = "fast",
        [T3R_PRESET_BALANCED] = "balanced",
        [T3R_PRESET_BEST] = "best",
    };
    EVERY_NAME(names, T3R_PRESET_COUNT);
    return pick(names, T3R_PRESET_COUNT, (uint32_t)preset);
}

#define WAVELET_NAME(NAME, name) [T3R_WAVELET_##NAME] = #name,

const char *t3r_wavelet_name(t3r_wavelet wavelet)
{
    static const char *const names[] = {T3R_WAVELETS(WAVELET_NAME)};
    EVERY_NAME(names, T3R_WAVELET_COUNT);
    return pick(names, T3R_WAVELET_COUNT, (uint32_t)wavelet);
}

const char *t3r_pixel_format_name(t3r_pixel_format format)
{
    static const char *const names[] = {
        [T3R_PIXEL_RGB24] = "rgb24", [T3R_PIXEL_BGR24] = "bgr24", [T3R_PIXEL_GREY] = "grey",
        [T3R_PIXEL_YUYV] = "yuyv",   [T3R_PIXEL_UYVY] = "uyvy",   [T3R_PIXEL_NV12] = "nv12",
    };
    EVERY_NAME(names, T3R_PIXEL_FORMAT_COUNT);
    return pick(names, T3R_PIXEL_FORMAT_COUNT, (uint32_t)format);
}

const char *t3r_pair_text(t3r_pair pair)
{
    static const char *const names[] = {
        [T3R_PAIR_OK] = "the views can be matched",
        [T3R_PAIR_NO_BASELINE] = "no baseline: both views are from one place and one direction",
        [T3R_PAIR_ROTATION] = "pure rotation: both views are from one place",
        [T3R_PAIR_OVERLAP] = "too little overlap: hardly anything is in both views",
        [T3R_PAIR_PARALLAX] = "too little parallax: what is in both views hardly moves between them",
        [T3R_PAIR_SCALE] = "the distance between the views is too large or too small for a depth unit",
    };
    EVERY_NAME(names, T3R_PAIR_COUNT);
    const char *text = pick(names, T3R_PAIR_COUNT, (uint32_t)pair);
    return text != NULL ? text : "unknown";
}

const char *t3r_error_text(t3r_status status)
{
    switch (status) {
    case T3R_OK:
        return "no error";
    case T3R_ERR_ARGUMENT:
        return "an argument is null or out of its range";
    case T3R_ERR_CONFIG:
        return "a setting is out of its range";
    case T3R_ERR_ARENA:
        return "the arena is too small or misaligned";
    case T3R_ERR_FRAME:
        return "the frame's format, size or stride cannot be read";
    case T3R_ERR_CAMERA:
        return "the camera is for another size, or its intrinsics, distortion or pose are out of range";
    case T3R_ERR_STATE:
        return "calls out of order";
    case T3R_ERR_NO_DEPTH:
        return "a context view has no valid depth";
    case T3R_ERR_CANCELLED:
        return "cancelled";
    case T3R_ERR_EPOCH:
        return "the arena was made by another version or build, of another size, or damaged";
    case T3R_ERR_FULL:
        return "the scene has no room for another Gaussian";
    case T3R_ERR_STEREO:
        return "no depth can be made of these views";
    case T3R_ERR_UNSUPPORTED:
        return "this library was built without what is asked for";
    case T3R_ERR_INTERFACE:
        return "the program was compiled with another trim3r.h, or other features, than the library";
    case T3R_ERR_WEIGHTS:
        return "the weights are damaged, of another version, or of too large a head for this arena";
    }
    return "unknown status";
}

const char *t3r_version(void)
{
    return T3R_VERSION;
}

uint64_t t3r_interface(void)
{
    return t3r_header_interface();
}

uint32_t t3r_features(void)
{
    return T3R_FEATURES_BUILT;
}
