/* SPDX-License-Identifier: Apache-2.0 */
/* Nodes of a .glb: translations, rotations and uniform scales move the Gaussians; everything else is refused with a
 * reason. */
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/formats/glb/glb_nodes.h"
#include "test.h"

#define Q "0.7071067811865476"

/* Places mesh 0 by these nodes; 0, or -1. */
static int place(const char *nodes, glb_placement *out, char error[256])
{
    char text[2048];
    snprintf(text, sizeof text, "{\"nodes\": %s}", nodes);
    cJSON *root = cJSON_Parse(text);
    assert_non_null(root);
    error[0] = '\0';
    const int result = glb_find_placement(root, 0, out, error, 256);
    assert_int_equal(result != 0, error[0] != '\0');
    cJSON_Delete(root);
    return result;
}

/* Checks where (3, 5, 7) goes. */
static void check_point(const char *nodes, double x, double y, double z)
{
    glb_placement to;
    char error[256];
    if (place(nodes, &to, error) != 0) {
        fail_msg("%s: %s", nodes, error);
    }
    double point[3] = {3, 5, 7}, rotation[4] = {1, 0, 0, 0}, none[HARMONICS_REST_MOST][3];
    const double want[3] = {x, y, z};
    if (!to.none) {
        scene_turn_apply(&to.turn, point, rotation, 0, none);
    }
    for (int i = 0; i < 3; i++) {
        const double at = to.none ? point[i] : point[i] * to.scale + to.translation[i];
        if (!(fabs(at - want[i]) < 1e-12)) {
            fail_msg("%s: item %d is %g, not %g", nodes, i, at, want[i]);
        }
    }
}

TEST(moves)
{
    check_point("[]", 3, 5, 7);
    check_point("[{\"mesh\": 1, \"scale\": [1, 2, 3]}]", 3, 5, 7); /* of another mesh */
    check_point("[{\"mesh\": 0}]", 3, 5, 7);
    check_point("[{\"mesh\": 0, \"translation\": [1, 2, 3]}]", 4, 7, 10);
    check_point("[{\"mesh\": 0, \"scale\": [2, 2, 2]}]", 6, 10, 14);
    /* a quarter turn about y: x y z to z y -x */
    check_point("[{\"mesh\": 0, \"rotation\": [0, " Q ", 0, " Q "]}]", 7, 5, -3);
    /* first the scale, then the rotation, then the translation */
    check_point("[{\"mesh\": 0, \"translation\": [1, 2, 3], \"scale\": [2, 2, 2], \"rotation\": [0, " Q ", 0, " Q "]}]",
                15, 12, -3);
    /* the same, as columns */
    check_point("[{\"mesh\": 0, \"matrix\": [0, 0, -2, 0, 0, 2, 0, 0, 2, 0, 0, 0, 1, 2, 3, 1]}]", 15, 12, -3);
}

TEST(goes_up_the_tree)
{
    /* the mesh's own node comes first, the root last */
    check_point("[{\"children\": [2], \"translation\": [1, 0, 0]}, {\"mesh\": 0, \"scale\": [2, 2, 2]},"
                " {\"children\": [1], \"rotation\": [0, " Q ", 0, " Q "]}]",
                15, 10, -6);
    /* unequal scales that cancel each other */
    check_point("[{\"scale\": [2, 1, 4], \"children\": [1]}, {\"mesh\": 0, \"scale\": [0.5, 1, 0.25]}]", 3, 5, 7);
    /* a node next to it */
    check_point("[{\"translation\": [9, 9, 9], \"children\": [1]}, {\"mesh\": 7}, {\"mesh\": 0}]", 3, 5, 7);
}

TEST(refuses)
{
    static const struct {
        const char *nodes, *reason;
    } bad[] = {
        {"[{\"mesh\": 0, \"scale\": [1, 2, 1]}]", "by other amounts"},
        {"[{\"mesh\": 0, \"scale\": [-1, 1, 1]}]", "mirror"},
        {"[{\"mesh\": 0, \"scale\": [-1, -1, -1]}]", "mirror"},
        {"[{\"mesh\": 0, \"scale\": [0, 1, 1]}]", "flat"},
        {"[{\"mesh\": 0, \"scale\": [1e200, 1e200, 1e200]}]", "mirror"},
        {"[{\"mesh\": 0, \"scale\": 2}]", "scale is not 3"},
        {"[{\"mesh\": 0, \"scale\": [1, 1, \"x\"]}]", "finite numbers"},
        {"[{\"mesh\": 0, \"translation\": [1, 1]}]", "translation is not 3"},
        {"[{\"mesh\": 0, \"rotation\": [0, 0, 0, 0]}]", "length 1"},
        {"[{\"mesh\": 0, \"rotation\": [0, 1, 0, 1]}]", "length 1"},
        {"[{\"mesh\": 0, \"matrix\": [1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]", "shear"},
        {"[{\"mesh\": 0, \"matrix\": [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]", "last row"},
        {"[{\"mesh\": 0, \"matrix\": [1, 0, 0]}]", "matrix is not 16"},
        {"[{\"mesh\": 0, \"matrix\": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], \"scale\": [1, 1, 1]}]",
         "beside"},
        {"[{\"mesh\": 0}, {\"mesh\": 0}]", "nodes 0 and 1 show"},
        {"[{\"mesh\": 0, \"children\": [0]}]", "their own children"},
        {"[{\"mesh\": 0, \"children\": [1]}, {\"children\": [0]}]", "their own children"},
        {"[{\"children\": [2]}, {\"children\": [2]}, {\"mesh\": 0}]", "the child of two"},
        {"[{\"mesh\": 0, \"children\": [1]}]", "no node"},
        {"[{\"mesh\": 0, \"children\": [-1]}]", "no node"},
        {"[{\"mesh\": 0, \"children\": [0.5]}]", "no node"},
        {"[{\"mesh\": 0, \"children\": [{}]}]", "no node"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        glb_placement to;
        char error[256];
        if (place(bad[i].nodes, &to, error) == 0 || strstr(error, bad[i].reason) == NULL) {
            fail_msg("%s: '%s' does not say '%s'", bad[i].nodes, error, bad[i].reason);
        }
    }
}
