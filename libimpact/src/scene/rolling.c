/* SPDX-License-Identifier: MIT */
#include "scene/rolling.h"
#include "base/tolerances.h"

#include <impact/flight.h>

typedef struct ball_roll {
    const imp_body *ball, *plane;
    const imp_state *state, *ground;
    const imp_touch *touch;
    qvec3 normal, down; /* down: g_t, m/s^2 */
    double press;       /* -g.n, m/s^2 */
} ball_roll;

static bool find_roll(const imp_island *island, ball_roll *r)
{
    const imp_world *world = &island->world;
    const imp_persist *persist = &island->motion.persist;
    if (world->body_count != 2 || persist->count != 1 || world->field_count > 0 || world->driven) return false;
    r->touch = &persist->touches[0];
    r->ball = &world->bodies[r->touch->body1], r->plane = &world->bodies[r->touch->body2];
    r->state = &island->states[r->touch->body1], r->ground = &island->states[r->touch->body2];
    if (!imp_is_ball(r->ball) || !r->ball->spherical || r->plane->shape.kind != IMPACT_PLANE) return false;
    if (r->ball->linear_rate != 0 || r->ball->angular_rate != 0 || r->touch->still) return false;
    r->normal = r->touch->normal;
    r->press = -qvec3_dot(world->gravity, r->normal);
    r->down = qvec3_axpy(r->press, r->normal, world->gravity);
    if (qvec3_norm(r->down) <= IMP_LEVEL * r->press) r->down = (qvec3){0, 0, 0};
    return r->press > 0;
}

/* The line of the slip, or of what it begins along; false where it turns. */
static bool find_line(const ball_roll *r, qvec3 *line)
{
    const double slip = qvec3_norm(r->touch->slip), pull = qvec3_norm(r->down);
    const bool begins = r->touch->onset;
    if (begins || slip == 0) {
        *line = qvec3_scale(r->down, pull > 0 ? 1 / pull : 0);
        return pull > 0;
    }
    *line = qvec3_scale(r->touch->slip, 1 / slip);
    const double speeds = qvec3_norm(r->state->v) + r->ball->radius * qvec3_norm(imp_omega(r->ball, r->state));
    const double roundings = IMP_LEVEL * (r->press * slip + pull * speeds);
    return pull == 0 || qvec3_norm(qvec3_cross(r->down, r->touch->slip)) <= roundings;
}

/* When the ball's place on a bounded plane leaves the bounds, s. */
static double find_bounds(const ball_roll *r, qvec3 a)
{
    const quat q = r->ground->q;
    const qvec3 x = quat_rotate_inverse(q, qvec3_sub(r->state->x, r->ground->x)),
                v = quat_rotate_inverse(q, r->state->v), b = quat_rotate_inverse(q, a);
    const double half[2] = {r->plane->shape.a, r->plane->shape.b}, place[2] = {x.x, x.y}, speed[2] = {v.x, v.y},
                 pull[2] = {b.x, b.y};
    double time = INFINITY;
    for (int k = 0; k < 2; k++) {
        if (!isfinite(half[k])) continue;
        time = fmin(time, impact_flight_fall_time(half[k] - place[k], -speed[k], -pull[k]));
        time = fmin(time, impact_flight_fall_time(half[k] + place[k], speed[k], pull[k]));
    }
    return time;
}

/* So long that its orientation, whose axis turns, is found in a thousand steps (motion/segment.c). */
static double longest(qvec3 omega, qvec3 alpha)
{
    const double most = 10, w = qvec3_norm(omega), up = qvec3_norm(alpha); /* rad */
    const qvec3 turns = qvec3_cross(omega, alpha);
    if (turns.x == 0 && turns.y == 0 && turns.z == 0) return INFINITY;
    return 2 * most / (w + sqrt(w * w + 2 * up * most));
}

bool imp_island_rolls(const imp_island *island, imp_segment *segment, imp_end *end)
{
    ball_roll r;
    if (!find_roll(island, &r)) return false;
    const double m = r.ball->mass, J = r.ball->moments.x, radius = r.ball->radius;
    qvec3 a = r.down, alpha = {0, 0, 0}, line;
    double fades = INFINITY;
    if (r.touch->mode == IMP_ROLL) {
        a = qvec3_scale(r.down, 1 / (1 + J / (m * radius * radius)));
        alpha = qvec3_scale(qvec3_cross(r.normal, a), 1 / radius);
    } else if (r.touch->friction > 0) {
        if (!find_line(&r, &line)) return false;
        const qvec3 f = qvec3_scale(line, -r.touch->friction * m * r.press);
        a = qvec3_axpy(1 / m, f, r.down);
        alpha = qvec3_scale(qvec3_cross(r.normal, f), -radius / J);
        const double rate = qvec3_dot(line, qvec3_axpy(1 / m + radius * radius / J, f, r.down));
        const double slip = qvec3_dot(line, r.touch->slip);
        if (rate < 0) fades = slip / -rate;
        if (rate < 0 && !(slip > 0)) return false; /* it would stick: not for here to say */
    }
    const double leaves = find_bounds(&r, a), pause = longest(imp_omega(r.ball, r.state), alpha);
    const double time = fmin(pause, fmin(fades, leaves));
    const imp_end_kind kind = time == fades ? IMP_END_STICK : time == leaves ? IMP_END_BOUNDS : IMP_END_RENEWAL;
    *end = (imp_end){isfinite(time) ? kind : IMP_END_TIME, r.touch->pair};
    *segment = imp_segment_roll(island->t, island->t + time, r.state, a, alpha);
    return time > 0 && island->t + time > island->t;
}
