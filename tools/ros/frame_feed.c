/* SPDX-License-Identifier: Apache-2.0 */
#include "ros/frame_feed.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/reason.h"
#include "import/bags/bag_pictures.h"
#include "messages/message_frame.h"
#include "messages/pixel_layout.h"
#include "recording/frame_pairing.h"
#include "ros/throttle.h"

#define POSES_MOST 256u
#define JUMP_NS INT64_C(1000000000) /* stamps that go back this far mean that the clock was reset */
#define WHAT_BYTES 160u

typedef struct image_slot {
    bool used;
    t3r_ros_image image;
    char frame[FRAME_FEED_NAME_BYTES];
    void *owner;
    picture decoded;
} image_slot;

typedef struct stamped_pose {
    t3r_ros_pose pose; /* without its texts */
    char child[FRAME_FEED_NAME_BYTES];
} stamped_pose;

struct frame_feed {
    frame_feed_settings settings;
    t3r_pairing pairing;
    image_slot slots[2][T3R_PAIRING_MOST + 1]; /* for colour and depth: one more than may wait, for the current pair */
    bool has_pair;                             /* a pair waits for its pose */
    uint32_t pair[2];
    int64_t pair_since_ns;
    stamped_pose poses[POSES_MOST]; /* oldest first */
    uint32_t pose_count;
    char world[FRAME_FEED_NAME_BYTES];
    bool has_info, rectified;
    t3r_ros_camera_info info; /* without its texts */
    char info_model[32], info_frame[FRAME_FEED_NAME_BYTES];
    int64_t last_ns[FRAME_FEED_TOPICS]; /* stamps; INT64_MIN: none yet */
    throttle warnings[FRAME_FEED_TOPICS];
    bag_pictures pictures; /* of the current pair: its decoded colour, what is redrawn and hidden */
    uint8_t *z16;          /* converted depth */
    size_t z16_bytes;
    frame_feed_counts counts;
};

/* Returns 0, or -1 with what is wrong as the reason. */
static int verdict(const char *wrong, char *reason)
{
    return wrong == NULL ? 0 : t3r_reason(reason, FRAME_FEED_REASON_BYTES, "%s", wrong);
}

/* ---- opening and closing --------------------------------------------------------------------------------------- */

frame_feed_settings frame_feed_defaults(void)
{
    return (frame_feed_settings){
        .queue = 8,
        .pair_ns = 20 * INT64_C(1000000),
        .patience_ns = 500 * INT64_C(1000000),
        .depth_unit_q40 = UINT64_C(1099511628), /* a millimetre */
        .world = "",
    };
}

static void forget_stamps(frame_feed *feed)
{
    for (int i = 0; i < FRAME_FEED_TOPICS; i++) {
        feed->last_ns[i] = INT64_MIN;
    }
}

frame_feed *frame_feed_open(const frame_feed_settings *settings, char *error, size_t error_bytes)
{
    const char *wrong = settings->queue < 2 || settings->queue > T3R_PAIRING_MOST ? "queue is outside 2..32"
                        : settings->pair_ns < 0 || settings->patience_ns < 0      ? "a time is negative"
                        : settings->depth_unit_q40 == 0                           ? "the depth unit is 0"
                        : strlen(settings->world) >= FRAME_FEED_NAME_BYTES        ? "the world's name is too long"
                                                                                  : NULL;
    frame_feed *feed = wrong == NULL ? calloc(1, sizeof *feed) : NULL;
    if (feed == NULL) {
        t3r_reason(error, error_bytes, "%s", wrong != NULL ? wrong : "out of memory");
        return NULL;
    }
    feed->settings = *settings;
    snprintf(feed->world, sizeof feed->world, "%s", settings->world);
    feed->settings.world = NULL;
    feed->pairing.most = settings->queue;
    feed->pairing.near_ns = settings->pair_ns;
    feed->pairing.patience_ns = settings->patience_ns;
    forget_stamps(feed);
    return feed;
}

static void free_slot(frame_feed *feed, image_slot *slot)
{
    if (slot->used && slot->owner != NULL) {
        feed->settings.release(feed->settings.user, slot->owner);
    }
    picture_free(&slot->decoded);
    *slot = (image_slot){0};
}

static void empty_queues(frame_feed *feed)
{
    for (uint32_t i = 0; i <= T3R_PAIRING_MOST; i++) {
        free_slot(feed, &feed->slots[FRAME_FEED_COLOUR][i]);
        free_slot(feed, &feed->slots[FRAME_FEED_DEPTH][i]);
    }
    feed->pairing.colour.count = feed->pairing.depth.count = 0;
    feed->pairing.depth_last_ns = feed->pairing.depth_interval_ns = 0;
    feed->has_pair = false;
    feed->pose_count = 0;
    forget_stamps(feed);
}

void frame_feed_close(frame_feed *feed)
{
    if (feed != NULL) {
        empty_queues(feed);
        bag_pictures_free(&feed->pictures);
        free(feed->z16);
        free(feed);
    }
}

frame_feed_counts frame_feed_counts_of(const frame_feed *feed)
{
    return feed->counts;
}

/* ---- warnings -------------------------------------------------------------------------------------------------- */

void frame_feed_warn(frame_feed *feed, frame_feed_topic topic, const char *reason, int64_t now_ns)
{
    uint64_t more;
    if (!throttle_passes(&feed->warnings[topic], reason, now_ns, &more)) {
        return;
    }
    char line[FRAME_FEED_REASON_BYTES];
    if (more > 0) {
        t3r_reason(line, sizeof line, "%s (%" PRIu64 " more like the previous one)", reason, more);
    } else {
        t3r_reason(line, sizeof line, "%s", reason);
    }
    feed->settings.warn(feed->settings.user, topic, line);
}

static void refuse_colour(frame_feed *feed, frame_feed_topic topic, int64_t now_ns, const char *reason)
{
    feed->counts.refused++;
    frame_feed_warn(feed, topic, reason, now_ns);
}

/* Checks that stamps of a topic ascend. A clock that was set back empties the queues. */
static bool is_in_order(frame_feed *feed, frame_feed_topic topic, int64_t stamp_ns, int64_t now_ns)
{
    const int64_t last_ns = feed->last_ns[topic];
    if (last_ns != INT64_MIN && stamp_ns <= last_ns) {
        if (last_ns - stamp_ns < JUMP_NS) {
            frame_feed_warn(feed, topic, "the stamp is not after the previous message's", now_ns);
            return false;
        }
        frame_feed_warn(feed, topic, "time went back: waiting messages are dropped, the map stays", now_ns);
        empty_queues(feed);
    }
    feed->last_ns[topic] = stamp_ns;
    return true;
}

/* ---- poses ----------------------------------------------------------------------------------------------------- */

static int64_t apart(int64_t a, int64_t b)
{
    return a < b ? b - a : a - b;
}

/* Finds the pose of the same time, else the nearest once a later one has arrived. */
static frame_feed_found find_pose(const frame_feed *feed, int64_t stamp_ns, const stamped_pose **found)
{
    *found = NULL;
    for (uint32_t i = 0; i < feed->pose_count; i++) {
        const stamped_pose *p = &feed->poses[i];
        const int64_t gap_ns = apart(p->pose.header.stamp_ns, stamp_ns);
        if (gap_ns <= feed->settings.pair_ns &&
            (*found == NULL || gap_ns < apart((*found)->pose.header.stamp_ns, stamp_ns))) {
            *found = p;
        }
    }
    const bool later = feed->pose_count > 0 && feed->poses[feed->pose_count - 1].pose.header.stamp_ns >= stamp_ns;
    return !later ? FRAME_FEED_NOT_YET : *found == NULL ? FRAME_FEED_NEVER : FRAME_FEED_FOUND;
}

/* Whether a pose is in the world of the settings, else of the first pose. */
static bool is_of_world(frame_feed *feed, t3r_text frame, int64_t now_ns)
{
    char name[FRAME_FEED_NAME_BYTES], reason[FRAME_FEED_REASON_BYTES];
    t3r_text_copy(name, sizeof name, frame);
    if (feed->world[0] == '\0') {
        memcpy(feed->world, name, sizeof name);
    }
    if (strcmp(feed->world, name) == 0) {
        return true;
    }
    t3r_reason(reason, sizeof reason, "header.frame_id is \"%s\", but the world is \"%s\"", name, feed->world);
    frame_feed_warn(feed, FRAME_FEED_POSE, reason, now_ns);
    return false;
}

static void keep_pose(frame_feed *feed, const t3r_ros_pose *pose)
{
    if (feed->pose_count == POSES_MOST) {
        feed->pose_count--;
        memmove(feed->poses, feed->poses + 1, feed->pose_count * sizeof *feed->poses);
    }
    stamped_pose *kept = &feed->poses[feed->pose_count++];
    kept->pose = *pose;
    t3r_text_copy(kept->child, sizeof kept->child, pose->child_frame_id);
    kept->pose.header.frame_id = kept->pose.child_frame_id = (t3r_text){0};
}

/* Finds the camera's pose at the colour image's time. */
static frame_feed_found locate(frame_feed *feed, const image_slot *colour, t3r_camera *camera, char *reason)
{
    const int64_t stamp_ns = colour->image.header.stamp_ns;
    t3r_ros_pose elsewhere;
    const t3r_ros_pose *pose = &elsewhere;
    frame_feed_found found;
    if (feed->settings.locate != NULL) {
        found = feed->settings.locate(feed->settings.user, stamp_ns, colour->frame, &elsewhere);
    } else {
        const stamped_pose *nearest;
        found = find_pose(feed, stamp_ns, &nearest);
        if (found == FRAME_FEED_FOUND && nearest->child[0] != '\0' && strcmp(nearest->child, colour->frame) != 0) {
            t3r_reason(reason, FRAME_FEED_REASON_BYTES, "the pose is of \"%s\", the image of \"%s\"", nearest->child,
                       colour->frame);
            return FRAME_FEED_NEVER;
        }
        pose = nearest == NULL ? NULL : &nearest->pose;
    }
    if (found != FRAME_FEED_FOUND) {
        t3r_reason(reason, FRAME_FEED_REASON_BYTES, "there is none at the time of a colour image");
        return found;
    }
    return verdict(t3r_message_pose(pose, camera), reason) == 0 ? FRAME_FEED_FOUND : FRAME_FEED_NEVER;
}

/* ---- a pair to a frame ----------------------------------------------------------------------------------------- */

static int take_depth(frame_feed *feed, const image_slot *slot, t3r_frame *frame, int64_t now_ns, char *reason)
{
    frame->depth_unit_q40 = feed->settings.depth_unit_q40;
    if (verdict(t3r_message_depth(&slot->image, frame), reason) != 0) {
        return -1;
    }
    if (frame->depth != NULL) {
        return 0;
    }
    const size_t bytes = (size_t)slot->image.width * slot->image.height * 2;
    if (bytes > feed->z16_bytes) {
        free(feed->z16);
        feed->z16 = malloc(bytes);
        feed->z16_bytes = feed->z16 == NULL ? 0 : bytes;
    }
    if (feed->z16 == NULL) {
        return t3r_reason(reason, FRAME_FEED_REASON_BYTES, "out of memory");
    }
    const uint32_t beyond = t3r_message_to_z16(&slot->image, feed->settings.depth_unit_q40, feed->z16);
    if (beyond > 0) {
        t3r_reason(reason, FRAME_FEED_REASON_BYTES,
                   "samples beyond 65535 steps, %" PRIu32 " of an image, have no depth: set depth_unit", beyond);
        frame_feed_warn(feed, FRAME_FEED_DEPTH, reason, now_ns);
    }
    frame->depth = feed->z16;
    return 0;
}

/* Checks that depth, which is registered to colour, can show the same view. */
static int check_aspect(const t3r_frame *frame, char *reason)
{
    return !t3r_message_is_stretched(frame)
               ? 0
               : t3r_reason(reason, FRAME_FEED_REASON_BYTES,
                            "depth is %" PRIu32 "x%" PRIu32 " and colour %" PRIu32 "x%" PRIu32
                            ": another aspect is not registered to colour",
                            frame->depth_width, frame->depth_height, frame->width, frame->height);
}

/* Checks that a message registered to the colour image names its frame, or none. */
static int check_frame(const image_slot *colour, const char *frame, char *reason)
{
    if (frame[0] == '\0' || strcmp(frame, colour->frame) == 0) {
        return 0;
    }
    return t3r_reason(reason, FRAME_FEED_REASON_BYTES, "header.frame_id is \"%s\", that of the colour image \"%s\"",
                      frame, colour->frame);
}

/* Fills in the intrinsics. A frame whose lens no camera holds is redrawn without its distortion. */
static int take_intrinsics(frame_feed *feed, const image_slot *colour, t3r_frame *frame, t3r_camera *camera,
                           bool *straightened, char *reason)
{
    if (!feed->has_info) {
        return t3r_reason(reason, FRAME_FEED_REASON_BYTES, "there is none yet");
    }
    if (check_frame(colour, feed->info_frame, reason) != 0) {
        return -1;
    }
    if (feed->info.width != colour->image.width || feed->info.height != colour->image.height) {
        return t3r_reason(reason, FRAME_FEED_REASON_BYTES,
                          "width x height is %" PRIu32 "x%" PRIu32 ", that of the image %" PRIu32 "x%" PRIu32,
                          feed->info.width, feed->info.height, colour->image.width, colour->image.height);
    }
    t3r_ros_camera_info info = feed->info;
    info.distortion_model = t3r_text_of(feed->info_model);
    const char *wrong = feed->rectified ? t3r_message_rectify(&info) : NULL;
    if (wrong != NULL) {
        return verdict(wrong, reason);
    }
    wrong = t3r_message_intrinsics(&info, camera);
    if (wrong == NULL || !t3r_message_is_bent(&info)) {
        return verdict(wrong, reason);
    }
    t3r_ros_camera_info pinhole = info;
    pinhole.d_count = 0;
    wrong = t3r_message_intrinsics(&pinhole, camera); /* K may be what is wrong */
    if (wrong != NULL) {
        return verdict(wrong, reason);
    }
    *straightened = true;
    const t3r_image_decoder decoder = bag_pictures_decoder(&feed->pictures);
    return decoder.straighten(decoder.user, &info, frame, true, reason, FRAME_FEED_REASON_BYTES);
}

/* Sets depth to 0 where colour is transparent. */
static int hide_depth(frame_feed *feed, t3r_frame *frame, bool straightened, char *reason)
{
    return verdict(bag_pictures_hide(&feed->pictures, frame, straightened) == 0 ? NULL : "out of memory", reason);
}

static void drop_pair(frame_feed *feed)
{
    for (int kind = 0; kind < 2; kind++) {
        free_slot(feed, &feed->slots[kind][feed->pair[kind]]);
    }
    feed->has_pair = false;
}

/* Whether something missing may still arrive: messages of several topics come in any order. */
static bool may_wait(const frame_feed *feed, int64_t now_ns)
{
    const t3r_pairing *pairing = &feed->pairing;
    const bool full = pairing->colour.count >= pairing->most || pairing->depth.count >= pairing->most;
    return !full && now_ns - feed->pair_since_ns < feed->settings.patience_ns;
}

/* Finishes the pair; false: it still waits for its pose, or for the first intrinsics. */
static bool finish_pair(frame_feed *feed, int64_t now_ns)
{
    image_slot *colour = &feed->slots[FRAME_FEED_COLOUR][feed->pair[FRAME_FEED_COLOUR]];
    const image_slot *depth = &feed->slots[FRAME_FEED_DEPTH][feed->pair[FRAME_FEED_DEPTH]];
    t3r_frame frame = {0};
    t3r_camera camera = {0};
    char reason[FRAME_FEED_REASON_BYTES] = "";
    frame_feed_topic topic = FRAME_FEED_TOPICS;
    const frame_feed_found found = locate(feed, colour, &camera, reason);
    if ((found == FRAME_FEED_NOT_YET || (found == FRAME_FEED_FOUND && !feed->has_info)) && may_wait(feed, now_ns)) {
        return false;
    }
    picture_free(&feed->pictures.colour);
    feed->pictures.colour = colour->decoded;
    colour->decoded = (picture){0};
    bool straightened = false;
    if (found != FRAME_FEED_FOUND) {
        topic = FRAME_FEED_POSE;
    } else if (verdict(t3r_message_colour(&colour->image, &frame), reason) != 0) {
        topic = FRAME_FEED_COLOUR;
    } else if (check_frame(colour, depth->frame, reason) != 0 || take_depth(feed, depth, &frame, now_ns, reason) != 0 ||
               check_aspect(&frame, reason) != 0) {
        topic = FRAME_FEED_DEPTH;
    } else if (take_intrinsics(feed, colour, &frame, &camera, &straightened, reason) != 0) {
        topic = FRAME_FEED_CAMERA_INFO;
    } else if (hide_depth(feed, &frame, straightened, reason) != 0) {
        topic = FRAME_FEED_DEPTH;
    }
    if (topic != FRAME_FEED_TOPICS) {
        refuse_colour(feed, topic, now_ns, reason);
    } else {
        feed->counts.frames++;
        feed->settings.frame(feed->settings.user, colour->image.header.stamp_ns, feed->world, &frame, &camera, now_ns);
    }
    drop_pair(feed);
    return true;
}

/* ---- the queues ------------------------------------------------------------------------------------------------ */

void frame_feed_tick(frame_feed *feed, int64_t now_ns)
{
    t3r_pairing *pairing = &feed->pairing;
    for (;;) { /* each round ends, or takes an image from a queue */
        if (feed->has_pair && !finish_pair(feed, now_ns)) {
            return;
        }
        int64_t gap_ns;
        switch (t3r_pairing_decide(pairing, now_ns, &gap_ns)) {
        case T3R_PAIRING_BOTH:
            feed->pair[FRAME_FEED_COLOUR] = t3r_pairing_take(&pairing->colour).buffer;
            feed->pair[FRAME_FEED_DEPTH] = t3r_pairing_take(&pairing->depth).buffer;
            feed->has_pair = true;
            feed->pair_since_ns = now_ns;
            break;
        case T3R_PAIRING_COLOUR:
            free_slot(feed, &feed->slots[FRAME_FEED_COLOUR][t3r_pairing_take(&pairing->colour).buffer]);
            refuse_colour(feed, FRAME_FEED_DEPTH, now_ns, "there is none at the time of a colour image");
            break;
        case T3R_PAIRING_NOT_DEPTH:
            free_slot(feed, &feed->slots[FRAME_FEED_DEPTH][t3r_pairing_take(&pairing->depth).buffer]);
            break;
        case T3R_PAIRING_WAIT:
        default:
            return;
        }
    }
}

/* Returns a free slot: queues hold one image less than there are slots, and the current pair is in no queue. */
static uint32_t free_place(const image_slot *slots)
{
    uint32_t place = 0;
    while (slots[place].used) {
        place++;
    }
    return place;
}

static void add_image(frame_feed *feed, frame_feed_topic topic, image_slot *slot, int64_t now_ns)
{
    frame_feed_tick(feed, now_ns); /* makes room: a full queue decides */
    const uint32_t place = free_place(feed->slots[topic]);
    const t3r_pairing_item item = {.stamp_ns = slot->image.header.stamp_ns, .arrived_ns = now_ns, .buffer = place};
    feed->slots[topic][place] = *slot;
    if (topic == FRAME_FEED_COLOUR) {
        t3r_pairing_add_colour(&feed->pairing, item);
    } else {
        t3r_pairing_add_depth(&feed->pairing, item);
    }
    frame_feed_tick(feed, now_ns);
}

static bool begin_image(frame_feed *feed, frame_feed_topic topic, int64_t stamp_ns, int64_t now_ns)
{
    feed->counts.images += topic == FRAME_FEED_COLOUR;
    const bool fits = is_in_order(feed, topic, stamp_ns, now_ns);
    feed->counts.refused += topic == FRAME_FEED_COLOUR && !fits;
    return fits;
}

/* Takes a decoded picture as the image that a driver would have sent. */
static void keep_decoded(picture *decoded, t3r_pixel_format format, bool depth, image_slot *slot)
{
    slot->decoded = *decoded;
    *decoded = (picture){0};
    slot->image.width = slot->decoded.width;
    slot->image.height = slot->decoded.height;
    slot->image.encoding = t3r_text_of(depth ? "16UC1" : t3r_pixel_encoding(format));
    slot->image.step = depth ? slot->decoded.width * 2 : t3r_pixel_row_bytes(format, slot->decoded.width);
    slot->image.data = slot->decoded.samples;
    slot->image.data_bytes = slot->image.step * slot->decoded.height; /* sides are at most 4096 */
}

/* Takes what the decoder made of an image, unless something is wrong with it. */
static void take_decoded(frame_feed *feed, frame_feed_topic topic, const char *wrong, const t3r_decoded_image *decoded,
                         image_slot *slot, int64_t now_ns)
{
    const bool depth = topic == FRAME_FEED_DEPTH;
    if (wrong == NULL) {
        wrong = t3r_pixel_size_error(depth ? T3R_PIXEL_GREY : decoded->format, decoded->width, decoded->height);
    }
    if (wrong == NULL) {
        keep_decoded(depth ? &feed->pictures.depth : &feed->pictures.colour, decoded->format, depth, slot);
    } else {
        feed->counts.refused += !depth;
        frame_feed_warn(feed, topic, wrong, now_ns);
    }
}

void frame_feed_colour_topic(frame_feed *feed, const char *name)
{
    feed->rectified = t3r_topic_is_rectified(name);
}

void frame_feed_image(frame_feed *feed, frame_feed_topic topic, const t3r_ros_image *image, void *owner, int64_t now_ns)
{
    if (!begin_image(feed, topic, image->header.stamp_ns, now_ns)) {
        feed->settings.release(feed->settings.user, owner);
        return;
    }
    image_slot slot = {.used = true, .image = *image, .owner = owner};
    t3r_text_copy(slot.frame, sizeof slot.frame, image->header.frame_id);
    const bool converted = topic == FRAME_FEED_COLOUR && t3r_pixel_is_converted(image->encoding);
    if (converted) {
        char reason[WHAT_BYTES] = "";
        const t3r_image_decoder decoder = bag_pictures_decoder(&feed->pictures);
        t3r_decoded_image decoded;
        const int code = decoder.convert(decoder.user, image, &decoded, reason, sizeof reason);
        take_decoded(feed, topic, code == 0 ? NULL : reason, &decoded, &slot, now_ns);
        feed->settings.release(feed->settings.user, owner);
        slot.owner = NULL;
    }
    if (!converted || slot.decoded.samples != NULL) {
        add_image(feed, topic, &slot, now_ns);
    }
}

void frame_feed_compressed(frame_feed *feed, frame_feed_topic topic, const t3r_ros_compressed *image, void *owner,
                           int64_t now_ns)
{
    char reason[WHAT_BYTES] = "";
    image_slot slot = {.used = true, .image.header = image->header};
    t3r_text_copy(slot.frame, sizeof slot.frame, image->header.frame_id);
    if (begin_image(feed, topic, image->header.stamp_ns, now_ns)) {
        const t3r_image_decoder decoder = bag_pictures_decoder(&feed->pictures);
        t3r_decoded_image decoded;
        const int code =
            decoder.decode(decoder.user, image->format, image->data, image->data_bytes, topic == FRAME_FEED_DEPTH,
                           feed->settings.depth_unit_q40, &decoded, reason, sizeof reason);
        take_decoded(feed, topic, code == 0 ? NULL : reason, &decoded, &slot, now_ns);
    }
    feed->settings.release(feed->settings.user, owner);
    if (slot.decoded.samples != NULL) {
        add_image(feed, topic, &slot, now_ns);
    }
}

void frame_feed_camera_info(frame_feed *feed, const t3r_ros_camera_info *info, int64_t now_ns)
{
    feed->info = *info;
    t3r_text_copy(feed->info_model, sizeof feed->info_model, info->distortion_model);
    t3r_text_copy(feed->info_frame, sizeof feed->info_frame, info->header.frame_id);
    feed->info.header.frame_id = (t3r_text){0};
    feed->has_info = true;
    frame_feed_tick(feed, now_ns);
}

/* Counts a pose that is none; wrong NULL: it is one. */
static bool is_pose(frame_feed *feed, const char *wrong, int64_t now_ns)
{
    if (wrong != NULL) {
        feed->counts.poses_left_out++;
        frame_feed_warn(feed, FRAME_FEED_POSE, wrong, now_ns);
    }
    return wrong == NULL;
}

void frame_feed_pose(frame_feed *feed, const t3r_ros_pose *pose, int64_t now_ns)
{
    if (is_pose(feed, t3r_message_pose_error(pose), now_ns) && is_of_world(feed, pose->header.frame_id, now_ns) &&
        is_in_order(feed, FRAME_FEED_POSE, pose->header.stamp_ns, now_ns)) {
        keep_pose(feed, pose);
        frame_feed_tick(feed, now_ns);
    }
}

bool frame_feed_transform(frame_feed *feed, const t3r_ros_pose *transform, int64_t now_ns)
{
    return is_pose(feed, t3r_message_transform_error(transform), now_ns);
}
