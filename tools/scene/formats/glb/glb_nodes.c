/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/formats/glb/glb_nodes.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/tables/json_input.h"
#include "geometry/quaternion.h"
#include "host/reason.h"

#define NO_NODE UINT32_MAX

/* linear x point + translation; linear is row-major */
typedef struct affine {
    double linear[9], translation[3];
} affine;

typedef struct node {
    const cJSON *json;
    uint32_t above; /* index of its parent, or NO_NODE */
} node;

typedef struct node_list {
    node *nodes;
    uint32_t count;
    char *error;
    size_t error_bytes;
} node_list;

#define FAIL(l, ...) t3r_reason((l)->error, (l)->error_bytes, __VA_ARGS__)

static const cJSON *get(const cJSON *object, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

/* Sets the parent of each child of a node. */
static int list_children(node_list *l, uint32_t index)
{
    const cJSON *child, *children;
    if (json_array(l->nodes[index].json, "children", &children, l->error, l->error_bytes) != 0) {
        return -1;
    }
    cJSON_ArrayForEach(child, children)
    {
        const double to = cJSON_IsNumber(child) ? child->valuedouble : -1;
        if (!(to >= 0 && to < l->count) || to != floor(to)) {
            return FAIL(l, "node %" PRIu32 ": a child that is no node", index);
        }
        node *below = &l->nodes[(uint32_t)to];
        if (below->above != NO_NODE) {
            return FAIL(l, "node %" PRIu32 " is the child of two", (uint32_t)to);
        }
        below->above = index;
    }
    return 0;
}

static int list_nodes(node_list *l, const cJSON *root)
{
    const cJSON *nodes, *each;
    if (json_array(root, "nodes", &nodes, l->error, l->error_bytes) != 0) {
        return -1;
    }
    l->count = (uint32_t)cJSON_GetArraySize(nodes);
    l->nodes = malloc(((size_t)l->count + 1) * sizeof *l->nodes);
    if (l->nodes == NULL) {
        return FAIL(l, "out of memory for %" PRIu32 " nodes", l->count);
    }
    uint32_t at = 0;
    cJSON_ArrayForEach(each, nodes)
    {
        l->nodes[at++] = (node){each, NO_NODE};
    }
    for (uint32_t i = 0; i < l->count; i++) {
        if (list_children(l, i) != 0) {
            return -1;
        }
    }
    return 0;
}

/* Finds the node that shows a mesh, or NO_NODE. */
static int find_node(const node_list *l, uint32_t mesh_index, uint32_t *out)
{
    *out = NO_NODE;
    for (uint32_t i = 0; i < l->count; i++) {
        const cJSON *mesh = get(l->nodes[i].json, "mesh");
        if (!cJSON_IsNumber(mesh) || mesh->valuedouble != mesh_index) {
            continue;
        }
        if (*out != NO_NODE) {
            return FAIL(l, "nodes %" PRIu32 " and %" PRIu32 " show the Gaussians: one is read", *out, i);
        }
        *out = i;
    }
    return 0;
}

/* Reads `count` finite numbers of a node; if missing, `out` is unchanged. */
static int get_numbers(const node_list *l, uint32_t index, const char *name, int count, double *out)
{
    const cJSON *array = get(l->nodes[index].json, name), *each;
    int at = 0;
    if (array == NULL) {
        return 0;
    }
    if (!cJSON_IsArray(array) || cJSON_GetArraySize(array) != count) {
        return FAIL(l, "node %" PRIu32 ": %s is not %d numbers", index, name, count);
    }
    cJSON_ArrayForEach(each, array)
    {
        if (!cJSON_IsNumber(each) || !isfinite(each->valuedouble)) {
            return FAIL(l, "node %" PRIu32 ": %s is not %d finite numbers", index, name, count);
        }
        out[at++] = each->valuedouble;
    }
    return 0;
}

/* Reads a matrix column by column, with 0 0 0 1 as the last row. */
static int of_matrix(const node_list *l, uint32_t index, affine *out)
{
    double columns[16] = {0};
    if (get_numbers(l, index, "matrix", 16, columns) != 0) {
        return -1;
    }
    if (columns[3] != 0 || columns[7] != 0 || columns[11] != 0 || columns[15] != 1) {
        return FAIL(l, "node %" PRIu32 ": the last row of its matrix is not 0 0 0 1", index);
    }
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++) {
            out->linear[3 * row + column] = columns[4 * column + row];
        }
        out->translation[row] = columns[12 + row];
    }
    return 0;
}

/* Reads a scale, a rotation x y z w and a translation, applied in this order. */
static int of_parts(const node_list *l, uint32_t index, affine *out)
{
    double rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
    *out = (affine){.translation = {0}};
    if (get_numbers(l, index, "rotation", 4, rotation) != 0 || get_numbers(l, index, "scale", 3, scale) != 0 ||
        get_numbers(l, index, "translation", 3, out->translation) != 0) {
        return -1;
    }
    double unit[4] = {rotation[3], rotation[0], rotation[1], rotation[2]};
    if (!(fabs(quaternion_norm(unit) - 1) <= 5e-3)) {
        return FAIL(l, "node %" PRIu32 ": its rotation has not the length 1", index);
    }
    quaternion_normalise(unit);
    quaternion_matrix(unit, out->linear);
    for (int i = 0; i < 9; i++) {
        out->linear[i] *= scale[i % 3];
    }
    return 0;
}

static int affine_of(const node_list *l, uint32_t index, affine *out)
{
    const cJSON *json = l->nodes[index].json;
    if (get(json, "matrix") == NULL) {
        return of_parts(l, index, out);
    }
    return get(json, "translation") == NULL && get(json, "rotation") == NULL && get(json, "scale") == NULL
               ? of_matrix(l, index, out)
               : FAIL(l, "node %" PRIu32 ": a matrix beside a translation, rotation or scale", index);
}

/* Returns `below` followed by `above`. */
static affine joined(const affine *above, const affine *below)
{
    affine out = {.translation = {0}};
    for (int row = 0; row < 3; row++) {
        out.translation[row] = above->translation[row];
        for (int k = 0; k < 3; k++) {
            out.translation[row] += above->linear[3 * row + k] * below->translation[k];
            for (int column = 0; column < 3; column++) {
                out.linear[3 * row + column] += above->linear[3 * row + k] * below->linear[3 * k + column];
            }
        }
    }
    return out;
}

/* Splits the transform into a uniform scale, a rotation and a translation; any other transform would not keep a
 * Gaussian representable. */
static int place(const node_list *l, const affine *whole, glb_placement *out)
{
    const double *m = whole->linear;
    const double volume = matrix_determinant(m);
    double rotation[9], quaternion[4];
    if (!isfinite(volume) || !(volume > 0)) {
        return FAIL(l,
                    "its nodes mirror the Gaussians or make them flat: translation, rotation and one scale are read");
    }
    out->scale = cbrt(volume);
    for (int i = 0; i < 9; i++) {
        rotation[i] = m[i] / out->scale;
    }
    if (quaternion_of(rotation, quaternion) != NULL) {
        return FAIL(l, "its nodes scale the Gaussians by other amounts along other axes, or shear them: translation, "
                       "rotation and one scale are read");
    }
    memcpy(out->translation, whole->translation, sizeof out->translation);
    out->turn = scene_turn_of(quaternion);
    return 0;
}

static int find(node_list *l, const cJSON *root, uint32_t mesh_index, glb_placement *out)
{
    uint32_t index, steps = 0;
    affine whole = {.linear = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    *out = (glb_placement){.none = true, .scale = 1};
    if (list_nodes(l, root) != 0 || find_node(l, mesh_index, &index) != 0) {
        return -1;
    }
    for (; index != NO_NODE; index = l->nodes[index].above) {
        const cJSON *json = l->nodes[index].json;
        affine own;
        if (steps++ == l->count) {
            return FAIL(l, "its nodes are their own children");
        }
        if (get(json, "matrix") == NULL && get(json, "translation") == NULL && get(json, "rotation") == NULL &&
            get(json, "scale") == NULL) {
            continue;
        }
        if (affine_of(l, index, &own) != 0) {
            return -1;
        }
        whole = joined(&own, &whole);
        out->none = false;
    }
    return out->none ? 0 : place(l, &whole, out);
}

int glb_find_placement(const cJSON *root, uint32_t mesh_index, glb_placement *out, char *error, size_t error_bytes)
{
    node_list l = {.error = error, .error_bytes = error_bytes};
    const int result = find(&l, root, mesh_index, out);
    free(l.nodes);
    return result;
}
