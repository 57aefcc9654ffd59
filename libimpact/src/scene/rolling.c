/* SPDX-License-Identifier: MIT */
#include "scene/rolling.h"
#include "base/tolerances.h"
#include "scene/scene_internal.h"

#include <impact/flight.h>

typedef struct ball_roll {
    const imp_body *ball, *plane;
    const imp_state *state, *ground;
    imp_mode mode;
    bool incipient;
    qvec3 slip;
    qvec3 normal, down; /* down: g_t, m/s^2 */
    double press;       /* -g.n, m/s^2 */
    double friction, torsional, rolling;
    double slowest; /* what moves at less stands still, m/s */
} ball_roll;

/* Constant accelerations until a time, s from now. */
typedef struct ball_motion {
    qvec3 a, alpha;
    double until;
    bool fades; /* the slip does then */
} ball_motion;

/* The pair's ball on its plane, with this normal; false where it is none, or has no constant loads. */
static bool find_ball(const imp_island *island, const imp_pair *pair, qvec3 normal, ball_roll *r)
{
    const imp_world *world = &island->world;
    if (world->body_count != 2 || world->field_count > 0 || world->driven) return false;
    r->ball = &world->bodies[pair->body1], r->plane = &world->bodies[pair->body2];
    r->state = &island->states[pair->body1], r->ground = &island->states[pair->body2];
    if (!imp_is_ball(r->ball) || !r->ball->spherical || r->plane->shape.kind != IMPACT_PLANE) return false;
    if (r->ball->linear_rate != 0 || r->ball->angular_rate != 0) return false;
    r->normal = normal;
    r->press = -qvec3_dot(world->gravity, r->normal);
    r->down = qvec3_axpy(r->press, r->normal, world->gravity);
    if (qvec3_norm(r->down) <= IMP_LEVEL * r->press) r->down = (qvec3){0, 0, 0};
    r->friction = pair->law.friction, r->torsional = pair->law.torsional, r->rolling = pair->law.rolling;
    r->slowest = island->scene->rest_speed;
    return r->press > 0;
}

static bool find_roll(const imp_island *island, ball_roll *r)
{
    const imp_held *held = &island->motion.held;
    if (held->count != 1 || held->contacts[0].still) return false;
    const imp_held_contact *contact = &held->contacts[0];
    r->mode = contact->mode, r->incipient = contact->incipient, r->slip = contact->slip;
    return find_ball(island, &island->world.pairs[contact->pair], contact->normal, r);
}

/* The line of the slip, or of what it begins along; false where it turns. */
static bool find_line(const ball_roll *r, qvec3 *line)
{
    const double slip = qvec3_norm(r->slip), pull = qvec3_norm(r->down);
    const bool begins = r->incipient;
    if (begins || slip == 0) {
        *line = qvec3_scale(r->down, pull > 0 ? 1 / pull : 0);
        return pull > 0;
    }
    *line = qvec3_scale(r->slip, 1 / slip);
    const double speeds = qvec3_norm(r->state->v) + r->ball->radius * qvec3_norm(imp_omega(r->ball, r->state));
    const double roundings = IMP_LEVEL * (r->press * slip + pull * speeds);
    return pull == 0 || qvec3_norm(qvec3_cross(r->down, r->slip)) <= roundings;
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

/* ---- without moments ---- */

static ball_motion roll_freely(const ball_roll *r)
{
    const double m = r->ball->mass, J = r->ball->moments.x, radius = r->ball->radius;
    const qvec3 a = qvec3_scale(r->down, 1 / (1 + J / (m * radius * radius)));
    return (ball_motion){a, qvec3_scale(qvec3_cross(r->normal, a), 1 / radius), INFINITY, false};
}

/* False where it turns, or would stick. */
static bool slide_freely(const ball_roll *r, ball_motion *motion)
{
    const double m = r->ball->mass, J = r->ball->moments.x, radius = r->ball->radius;
    qvec3 line;
    if (!find_line(r, &line)) return false;
    const qvec3 f = qvec3_scale(line, -r->friction * m * r->press);
    motion->a = qvec3_axpy(1 / m, f, r->down);
    motion->alpha = qvec3_scale(qvec3_cross(r->normal, f), -radius / J);
    const double rate = qvec3_dot(line, qvec3_axpy(1 / m + radius * radius / J, f, r->down));
    const double slip = qvec3_dot(line, r->slip);
    motion->fades = rate < 0;
    motion->until = rate < 0 ? slip / -rate : INFINITY;
    return !(rate < 0 && !(slip > 0)); /* it would stick: not for here to say */
}

/* ---- with moments ---- */

/* Of v what is along the line; false where there is more across it than roundings of the speed. */
static bool part_along(qvec3 v, qvec3 line, double speed, double *part)
{
    *part = qvec3_dot(v, line);
    return qvec3_norm(qvec3_axpy(-*part, line, v)) <= IMP_LEVEL * speed;
}

/* It stands but for its spin about the normal. */
static bool spin_down(const ball_roll *r, double spin, ball_motion *motion)
{
    const double rate = r->torsional * r->ball->mass * r->press / r->ball->moments.x;
    if (qvec3_norm(r->down) > 0) return false;
    *motion = (ball_motion){{0, 0, 0}, qvec3_scale(r->normal, spin > 0 ? -rate : rate), fabs(spin) / rate, false};
    return true;
}

static bool roll_against(const ball_roll *r, double spin, ball_motion *motion)
{
    const double m = r->ball->mass, J = r->ball->moments.x, radius = r->ball->radius, pull = qvec3_norm(r->down);
    const qvec3 v = qvec3_axpy(-qvec3_dot(r->state->v, r->normal), r->normal, r->state->v);
    const double speed = qvec3_norm(v), hold = r->rolling * r->press / radius;
    const bool moves = speed > r->slowest;
    if (spin != 0 && r->torsional > 0) return !moves && spin_down(r, spin, motion);
    *motion = (ball_motion){.until = INFINITY};
    if (!moves && pull <= hold) return pull == 0; /* on a slope it rests: to be proved */
    const qvec3 line = moves ? qvec3_scale(v, 1 / speed) : qvec3_scale(r->down, 1 / pull);
    double along_line;
    if (!part_along(r->down, line, pull, &along_line)) return false;
    const double a = (along_line - hold) / (1 + J / (m * radius * radius));
    motion->a = qvec3_scale(line, a);
    motion->alpha = qvec3_scale(qvec3_cross(r->normal, motion->a), 1 / radius);
    if (a < 0) motion->until = speed / -a;
    return qvec3_norm(qvec3_sub(motion->a, r->down)) <= r->friction * r->press;
}

static bool slide_against(const ball_roll *r, double spin, ball_motion *motion)
{
    const double m = r->ball->mass, J = r->ball->moments.x, radius = r->ball->radius;
    const qvec3 omega = imp_omega(r->ball, r->state), rolls = qvec3_axpy(-spin, r->normal, omega);
    qvec3 line;
    double turn;
    if ((spin != 0 && r->torsional > 0) || !find_line(r, &line)) return false;
    const qvec3 axis = qvec3_cross(r->normal, line);
    const double slip = qvec3_dot(line, r->slip), speeds = qvec3_norm(r->state->v) + radius * qvec3_norm(omega);
    if (!part_along(qvec3_scale(rolls, radius), axis, speeds, &turn)) return false;
    const bool turns = fabs(turn) > fmax(r->slowest, IMP_LEVEL * speeds);
    const double drive = radius * r->friction,
                 hold = turns && turn < 0 ? -r->rolling : fmin(r->rolling, turns ? INFINITY : drive);
    const double alpha = (drive - hold) * m * r->press / J;
    motion->a = qvec3_axpy(-r->friction * r->press, line, r->down);
    motion->alpha = qvec3_scale(axis, alpha);
    const double rate = qvec3_dot(line, motion->a) - radius * alpha;
    const double fades = rate < 0 ? slip / -rate : INFINITY;
    const double stops = turns && turn * alpha < 0 ? fabs(turn) / (radius * fabs(alpha)) : INFINITY;
    motion->until = fmin(fades, stops);
    motion->fades = fades <= stops && rate < 0;
    return !(rate < 0 && !(slip > 0));
}

static bool find_motion(const ball_roll *r, ball_motion *motion)
{
    const bool rolls = r->mode == IMP_STICK;
    if (r->torsional == 0 && r->rolling == 0) {
        if (rolls) return *motion = roll_freely(r), true;
        *motion = (ball_motion){.a = r->down, .until = INFINITY};
        return r->friction > 0 ? slide_freely(r, motion) : true;
    }
    const qvec3 omega = imp_omega(r->ball, r->state);
    const double about = qvec3_dot(omega, r->normal), radius = r->ball->radius;
    const double speeds = qvec3_norm(r->state->v) + radius * qvec3_norm(omega);
    const double spin = radius * fabs(about) > fmax(r->slowest, IMP_LEVEL * speeds) ? about : 0;
    return (rolls ? roll_against : slide_against)(r, spin, motion);
}

bool imp_island_rolls(const imp_island *island, imp_segment *segment, imp_end *end)
{
    ball_roll r;
    ball_motion motion;
    if (!find_roll(island, &r) || !find_motion(&r, &motion)) return false;
    const double leaves = find_bounds(&r, motion.a), pause = longest(imp_omega(r.ball, r.state), motion.alpha);
    const double time = fmin(pause, fmin(motion.until, leaves));
    const imp_end_kind kind = motion.fades && time == motion.until ? IMP_END_STICK
                              : time == leaves                     ? IMP_END_BOUNDS
                                                                   : IMP_END_RENEWAL;
    *end = (imp_end){isfinite(time) ? kind : IMP_END_TIME, island->motion.held.contacts[0].pair};
    *segment = imp_segment_roll(island->t, island->t + time, r.state, motion.a, motion.alpha);
    return time > 0 && island->t + time > island->t;
}

/* ---- what has no closed form ---- */

/* Whether the pair is a ball on a plane, and no other holds it. */
static bool is_lone_ball(const imp_island *island, const imp_pair *pair)
{
    const imp_world *world = &island->world;
    int held = 0;
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *other = &world->pairs[p];
        held += imp_is_held(other) && (other->body1 == pair->body1 || other->body2 == pair->body1);
    }
    return held == 1 && world->bodies[pair->body2].shape.kind == IMPACT_PLANE &&
           imp_is_ball(&world->bodies[pair->body1]);
}

bool imp_island_needs_steps(const imp_island *island)
{
    const imp_world *world = &island->world;
    int rough = 0, balls = 0;
    for (int p = 0; p < world->pair_count; p++) {
        const imp_pair *pair = &world->pairs[p];
        const bool rests = island->motion.resting[pair->body1] &&
                           (world->bodies[pair->body2].is_static || island->motion.resting[pair->body2]);
        if (!imp_is_held(pair) || !imp_is_rough(pair) || rests) continue;
        rough++;
        balls += is_lone_ball(island, pair);
    }
    imp_segment segment;
    imp_end end;
    if (rough == 0 || island->stepped) return false;
    if (balls < rough) return true;
    return island->motion.held.count == 1 && world->body_count == 2 && !imp_island_rolls(island, &segment, &end);
}

bool imp_island_rolls_out(const imp_island *island, const imp_pair *pair)
{
    const imp_world *world = &island->world;
    const quat axes = imp_shape_axes(&world->bodies[pair->body2], &island->states[pair->body2]);
    ball_roll r = {.mode = IMP_STICK};
    ball_motion motion;
    if (!find_ball(island, pair, quat_rotate(axes, (qvec3){0, 0, 1}), &r)) return false;
    const qvec3 slip = qvec3_axpy(-r.ball->radius, qvec3_cross(imp_omega(r.ball, r.state), r.normal), r.state->v);
    const qvec3 across = qvec3_axpy(-qvec3_dot(slip, r.normal), r.normal, slip);
    return qvec3_norm(across) <= world->slip_speed && find_motion(&r, &motion);
}
