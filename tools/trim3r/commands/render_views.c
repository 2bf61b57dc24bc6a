/* SPDX-License-Identifier: Apache-2.0 */
/* The views of `trim3r render`: of a recorded frame, of files, or around the scene. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "geometry/quaternion.h"
#include "import/import_source.h"
#include "scene/summary/scene_box.h"
#include "trim3r/commands/render.h"

#define ERROR_BYTES 512
#define ELEVATION (20 * M_PI / 180) /* of a turntable that begins at no given view */

static int view_of_recording(const render_options *o, viewpoint_list *views)
{
    t3r_recording *recording = import_source_open(o->recording);
    if (recording == NULL) {
        return CLI_BAD_INPUT;
    }
    t3r_capture_frame frame;
    int code = recorded_frame_read(recording, o->recording, o->view, &frame);
    if (code == CLI_OK) {
        views->items = calloc(1, sizeof *views->items);
        if (views->items == NULL) {
            code = cli_error(CLI_BAD_INPUT, "out of memory");
        } else {
            uint32_t width = frame.frame.width, height = frame.frame.height;
            views->items[0] = reconstruction_camera(&frame.camera, width, height, width, height);
            views->count = 1;
        }
    }
    t3r_recording_close(recording);
    return code;
}

/* Reads the poses of --pose or, with a lens, of --trajectory, and reports what is left out of them. */
static int read_poses(const render_options *o, const t3r_camera *lens, viewpoint_list *views)
{
    char error[ERROR_BYTES] = "";
    const char *path = lens != NULL ? o->trajectory : o->pose;
    const int status = lens != NULL ? viewpoint_read_trajectory(path, lens, views, error, sizeof error)
                                    : viewpoint_read_pose(path, o->width, o->height, views, error, sizeof error);
    return status == 0 ? pose_losses_print(&views->losses, path, o->strict) : cli_error(CLI_BAD_INPUT, "%s", error);
}

/* Finds the one camera whose lens a trajectory or a turntable takes: that of `views`, or that of --fov. */
static int find_lens(const render_options *o, const viewpoint_list *views, t3r_camera *lens)
{
    if (views->count > 1) {
        return cli_error(CLI_BAD_USAGE, "--pose %s holds %" PRIu32 " cameras: --%s takes one", o->pose, views->count,
                         o->orbit > 0 ? "orbit" : "trajectory");
    }
    if (views->count == 1) {
        *lens = views->items[0];
        return CLI_OK;
    }
    const double degrees = o->has_fov ? o->fov_degrees : RENDER_FOV;
    return viewpoint_from_angle(degrees, o->has_size ? o->width : RENDER_WIDTH, o->has_size ? o->height : RENDER_HEIGHT,
                                lens) == 0
               ? CLI_OK
               : cli_error(CLI_BAD_USAGE, "--fov %g at this --size: the focal length must be 8..16384 pixels", degrees);
}

/* Places a camera before and above the scene, so that a turn about it keeps the scene in the picture. */
static int place_before(const scene_file *scene, const scene_box *box, t3r_camera *camera)
{
    /* the turn sweeps a cylinder: its side touches the rays at left and right, its nearest edge those at the bottom */
    const double radius = hypot(box->half[0], box->half[2]), half = box->half[1];
    const double across = camera->fx_q16 / (camera->width * 0x1p15), down = camera->fy_q16 / (camera->height * 0x1p15);
    const double wide = radius * hypot(across, 1);
    const double high =
        (half * cos(ELEVATION) + radius * sin(ELEVATION)) * down + radius * cos(ELEVATION) - half * sin(ELEVATION);
    const double fits = fmax(wide, high), distance = fits > 0 ? fits : ldexp(2, scene->frame.exponent); /* one place */
    const double place[3] = {box->middle[0], box->middle[1] - distance * sin(ELEVATION),
                             box->middle[2] - distance * cos(ELEVATION)};
    const double tilt[4] = {cos(ELEVATION / 2), -sin(ELEVATION / 2), 0, 0};
    double to_world[4];
    rigid pose;
    scene_box_world(box, scene, place, pose.position);
    quaternion_conjugate(box->upright.rotation, to_world);
    quaternion_multiply(to_world, tilt, pose.rotation);
    return viewpoint_place(camera, &pose);
}

/* Replaces the views by those of a turntable, which begins at the given one, if there is one. */
static int turn_about(const render_options *o, const scene_file *scene, viewpoint_list *views)
{
    char error[ERROR_BYTES] = "";
    t3r_camera start;
    scene_box box;
    int code = find_lens(o, views, &start);
    if (code != CLI_OK) {
        return code;
    }
    if (scene_box_of(scene, o->up != T3R_UP_UNKNOWN ? o->up : scene->up, &box) != 0) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    if (views->count == 0 && place_before(scene, &box, &start) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s: too large to be seen whole", o->scene);
    }
    double centre[3];
    scene_box_world(&box, scene, box.middle, centre);
    viewpoint_list_free(views);
    return viewpoint_turn(&start, centre, box.upright.matrix + 3, o->orbit, o->arc, views, error, sizeof error) == 0
               ? CLI_OK
               : cli_error(CLI_BAD_INPUT, "%s", error);
}

int render_views(const render_options *o, const scene_file *scene, viewpoint_list *views)
{
    *views = (viewpoint_list){0};
    int code = o->recording != NULL ? view_of_recording(o, views)
               : o->pose != NULL    ? read_poses(o, NULL, views)
                                    : CLI_OK;
    if (code == CLI_OK && o->trajectory != NULL) {
        t3r_camera lens;
        code = find_lens(o, views, &lens);
        viewpoint_list_free(views);
        code = code == CLI_OK ? read_poses(o, &lens, views) : code;
    } else if (code == CLI_OK && o->orbit > 0) {
        code = turn_about(o, scene, views);
    }
    for (uint32_t i = 0; code == CLI_OK && o->has_size && i < views->count; i++) {
        t3r_camera *v = &views->items[i];
        *v = reconstruction_camera(v, v->width, v->height, o->width, o->height);
    }
    return code;
}
