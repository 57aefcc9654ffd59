/* SPDX-License-Identifier: MIT
 *
 * MuJoCo as a peer, for its ellipsoids: mj_geomDistance in a model of two, whose axes and places are set for each pair.
 */
#include "peers_gap.h"

#ifdef HAVE_MUJOCO
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <string.h>
#include <quat/rotation.h>

static mjModel *model;
static mjData *data;

typedef struct pose {
    double size[3], position[3], matrix[9], bound;
} pose;

enum { MOST = 2000 };
static pose poses[MOST][2];

static bool open_model(void)
{
    static const char *const xml =
        "<mujoco><worldbody><body><freejoint/><geom type='ellipsoid' size='1 1 1'/></body>"
        "<body><freejoint/><geom type='ellipsoid' size='1 1 1'/></body></worldbody></mujoco>";
    char error[300] = "";
    if (model) return true;
    mjSpec *spec = mj_parseXMLString(xml, NULL, error, sizeof error);
    model = spec ? mj_compile(spec, NULL) : NULL;
    if (spec) mj_deleteSpec(spec);
    if (!model) fprintf(stderr, "bench_gap: MuJoCo: %s\n", error);
    if (model) model->opt.ccd_iterations = 1000, data = mj_makeData(model);
    return data != NULL;
}

static bool load(const gap_case *cases, int count)
{
    if (!open_model() || count > MOST) return false;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) {
            const impact_solid *b = &cases[i].body[k];
            const qmat3 r = quat_to_matrix(b->orientation);
            poses[i][k] = (pose){.size = {b->shape.a, b->shape.b, b->shape.c},
                                 .position = {b->position.x, b->position.y, b->position.z},
                                 .bound = fmax(b->shape.a, fmax(b->shape.b, b->shape.c))};
            memcpy(poses[i][k].matrix, r.m, sizeof poses[i][k].matrix);
        }
    return true;
}

static bool distance(const gap_case *c, double setting, double *gap, qvec3 *normal)
{
    double ends[6] = {0};
    model->opt.ccd_tolerance = setting;
    for (int k = 0; k < 2; k++) {
        const pose *p = &poses[c->number][k];
        memcpy(model->geom_size + 3 * k, p->size, sizeof p->size);
        memcpy(data->geom_xpos + 3 * k, p->position, sizeof p->position);
        memcpy(data->geom_xmat + 9 * k, p->matrix, sizeof p->matrix);
        model->geom_rbound[k] = p->bound;
    }
    *gap = mj_geomDistance(model, data, 0, 1, 100, ends);
    const qvec3 d = {ends[0] - ends[3], ends[1] - ends[4], ends[2] - ends[5]};
    const double length = qvec3_norm(d);
    if (length > 0) *normal = qvec3_scale(d, (*gap < 0 ? -1 : 1) / length);
    return (*gap < 0) == (c->gap < 0);
}

const gap_peer gap_peers_mujoco[] = {{"MuJoCo", distance, 1e-6, GAP_ELLIPSOIDS, load},
                                     {"MuJoCo", distance, 1e-12, GAP_ELLIPSOIDS, load},
                                     {NULL, NULL, 0, GAP_ALL, NULL}};
#else
const gap_peer gap_peers_mujoco[] = {{NULL, NULL, 0, GAP_ALL, NULL}};
#endif
