/* SPDX-License-Identifier: MIT
 *
 * world: the bodies, pairs and forces of one scene as the rooms of motion see them. Internal.
 */
#ifndef IMP_WORLD_H
#define IMP_WORLD_H

#include "base/tolerances.h"

#include <quat/rotation.h>
#include <impact/force.h>
#include <impact/gap.h>
#include <impact/scene.h>
#include "base/arena.h"

/* What moves of a body. The angular momentum, not omega, is the state: it is what torque-free motion keeps. */
typedef struct imp_state {
    qvec3 x, v; /* side by side: they are looked at most */
    quat q;
    qvec3 momentum; /* angular, about the centre, world */
} imp_state;

/* What does not change of a body. What others ask of it, as they pass by, stands side by side at the front. */
typedef struct imp_body {
    double radius; /* of the bounding ball about the centre of mass */
    double inner;  /* of a ball within the shape, about its centre */
    int index;     /* in the scene's definition */
    bool is_static;
    bool spherical; /* three equal principal moments: omega is parallel to the angular momentum */
    bool shifted;   /* the shape stands aside of the body's frame: by offset and turn */
    bool driven;    /* static, and its surface moves along itself: by drift and spin */
    impact_shape shape;
    char *name; /* the scene's */
    void *user; /* the caller's */
    double mass, inverse_mass;
    qvec3 moments, inverse_moments;
    qvec3 offset; /* the shape's centre, body axes */
    qvec3 trail;  /* whose way viewers draw, body axes */
    quat turn;    /* its axes to the body's */
    double friction, restitution;
    double torsional, rolling;        /* friction against turning, m */
    double linear_rate, angular_rate; /* damping: -ln(1 - d), 1/s */
    qvec3 drift, spin;                /* the surface's point at r from the centre by drift + spin x r */
    const impact_shape *given;        /* as the definition has it; NULL: as it is */
} imp_body;

/* What a contact does. */
typedef enum imp_mode {
    IMP_OPEN,   /* apart, or about to be */
    IMP_BEYOND, /* apart: body 1 passed beside the bounds of the plane and is behind it */
    IMP_SLIDE,  /* held, sliding */
    IMP_STICK   /* held, the contact point at rest: rolling, pivoting or resting */
} imp_mode;

/* What a contact makes of its bodies' surfaces. */
typedef struct imp_law {
    double friction, restitution;
    double torsional, rolling; /* friction against turning, m: the sums of the bodies' */
    double stiffness;          /* 0: Hertz's */
} imp_law;

/* How far slip that began from rest has come. */
typedef enum imp_slip_stage {
    IMP_SLIP_GROSS,     /* it goes as it goes */
    IMP_SLIP_INCIPIENT, /* slower than the world's incipient_speed yet, along a direction that others' answers may turn
                         */
    IMP_SLIP_TURNED,    /* the same: that is where the slip went when it was last solved for, with this mobility */
    IMP_SLIP_SLOW       /* past incipient slip, and too slow yet for its direction to change smoothly */
} imp_slip_stage;

/* Of a contact that slides. */
typedef struct imp_sliding {
    imp_slip_stage stage;
    qvec3 direction; /* begun: about where the slip goes */
    double mobility; /* turned: imp_held_contact's */
} imp_sliding;

/* What body 1 stands on body 2 with. */
typedef enum imp_foot {
    IMP_FOOT_POINT, /* where gap and orientation put it */
    IMP_FOOT_SPOT,  /* held: a place of its surface that is integrated along (held_spot) */
    IMP_FOOT_FLAT,  /* held: a spot on whose face it lies as long as it rocks with less energy than lying (held_flat)
                     */
    IMP_FOOT_LINE,  /* the same along a line of its surface, its axis line kept level (held_line) */
    IMP_FOOT_FACE   /* with a face on what is static, and glides there (scene/gliding.h): not among what is held */
} imp_foot;

typedef struct imp_footing {
    imp_foot on;
    double spot[3]; /* that place */
    double lying;   /* flat, line: J */
    int line;
} imp_footing;

/* Whose face turns a contact's normal; of a lone point both surfaces do, and of lines that lie on each other. */
typedef enum imp_bearer { IMP_BORNE_BY_BOTH, IMP_BORNE_BY_1, IMP_BORNE_BY_2, IMP_BORNE_BY_LINES } imp_bearer;

/* Which point it is of two bodies with faces. */
typedef struct imp_site {
    bool placed; /* it is one of theirs at an instant: where it is, and stays */
    impact_contact contact;
    imp_bearer bearer;
    int corner;  /* > 0: it is this corner of body 1, counted from 1, on a plane, and may be held there (corner.h) */
    int face;    /* > 0: not a plane but this face of body 2, counted from 1 */
    double sunk; /* held corner: m: how far below it the other corners were where the stretch began, <= 0 */
    qvec3 side;  /* held rim: unit, body 1's shape's axes: where it stood where the step began; 0: not known */
} imp_site;

/* Whether both bodies stand still, held, and nothing is solved for. */
typedef struct imp_rest {
    bool still;
    qvec3
        reaction; /* on body 1, N: one that lets them, or did; what others are chosen next to, if they are not unique */
} imp_rest;

/* Two bodies that can touch, or one point of them; body1 moves. */
typedef struct imp_pair {
    int body1, body2;
    imp_law law;
    imp_mode mode;
    imp_sliding slip;
    imp_footing footing;
    imp_site site;
    imp_rest rest;
    bool met; /* by the steps of a pile: it was closed since the pile was looked at last */
    impact_gap_cache cache;
} imp_pair;

/* A force with its edges: inside[slot] tells whether the slot's body (wind) or couple of bodies (attraction) is within
 * reach. It is held between events, so that the forces are smooth there. */
typedef struct imp_field {
    impact_force_def def; /* name is owned; body is not used: see only */
    char *name;
    int only;   /* the one body it acts on, or -1 */
    int number; /* among the scene's */
    int slots;
    bool *inside;
    double *switches; /* custom: owned */
    double piece[2];  /* custom: between which switches the motion is now, s */
} imp_field;

/* How a scene asks for gaps, and the first pair whose gap was not found so. */
typedef struct imp_gaps {
    impact_gap_method method;
    double tolerance; /* libccd's */
    const char *failed[2];
} imp_gaps;

typedef struct imp_world {
    imp_arena *arena; /* the scene's: all memory of the world and of what moves it */
    int body_count, pair_count, field_count;
    imp_body *bodies;
    imp_pair *pairs;
    imp_field *fields;
    qvec3 gravity;
    bool driven;            /* one of its bodies is */
    double slip_speed;      /* m/s: slip that dies out below this sticks */
    double incipient_speed; /* m/s: slip that begins goes the way it is accelerated up to this */
    double flat_height;     /* m: bodies that rock on a face and rise less lie on it */
    imp_gaps *gaps;         /* the scene's; NULL: by Newton */
    impact_usage usage;
} imp_world;

/* Whether its contact resists turning. */
static inline bool imp_is_rough(const imp_pair *pair) { return pair->law.torsional > 0 || pair->law.rolling > 0; }

/* Whether body 2 stands and its surface turns on under what resists that, wherever it touches. */
static inline bool imp_is_turned(const imp_world *world, const imp_pair *pair)
{
    const imp_body *under = &world->bodies[pair->body2];
    return under->driven && imp_is_rough(pair) && qvec3_norm(under->spin) > 0;
}

static inline bool imp_mode_holds(imp_mode mode) { return mode >= IMP_SLIDE; }

static inline bool imp_is_held(const imp_pair *pair) { return imp_mode_holds(pair->mode); }

/* Whether it slides from rest, if it slides. */
static inline bool imp_is_incipient(const imp_pair *pair)
{
    return pair->slip.stage == IMP_SLIP_INCIPIENT || pair->slip.stage == IMP_SLIP_TURNED;
}

static inline void imp_end_incipient(imp_pair *pair)
{
    if (imp_is_incipient(pair)) pair->slip.stage = IMP_SLIP_GROSS;
}

/* Whether its place on body 1 is integrated along. */
static inline bool imp_is_carried(const imp_pair *pair)
{
    return pair->footing.on >= IMP_FOOT_SPOT && pair->footing.on <= IMP_FOOT_LINE;
}

/* Three equal moments, but for the rounding of the formulas that gave them, are a sphere's. */
static inline void imp_body_give_moments(imp_body *body, qvec3 m)
{
    body->moments = m;
    body->inverse_moments = (qvec3){1 / m.x, 1 / m.y, 1 / m.z};
    body->spherical = fabs(m.x - m.y) <= IMP_ALIKE_MOMENTS * m.x && fabs(m.x - m.z) <= IMP_ALIKE_MOMENTS * m.x;
}

/* J^-1 a, for a vector in the world frame. */
static inline qvec3 imp_inverse_inertia(const imp_body *body, quat q, qvec3 a)
{
    if (body->spherical) return qvec3_scale(a, body->inverse_moments.x);
    const qvec3 b = quat_rotate_inverse(q, a);
    return quat_rotate(
        q, (qvec3){b.x * body->inverse_moments.x, b.y * body->inverse_moments.y, b.z * body->inverse_moments.z});
}

/* J a, for a vector in the world frame; zero for a static body. */
static inline qvec3 imp_inertia(const imp_body *body, quat q, qvec3 a)
{
    if (body->is_static) return (qvec3){0, 0, 0};
    if (body->spherical) return qvec3_scale(a, body->moments.x);
    const qvec3 b = quat_rotate_inverse(q, a);
    return quat_rotate(q, (qvec3){b.x * body->moments.x, b.y * body->moments.y, b.z * body->moments.z});
}

static inline qvec3 imp_omega(const imp_body *body, const imp_state *state)
{
    return imp_inverse_inertia(body, state->q, state->momentum);
}

/* Kinetic + potential in uniform gravity of a body that moves, J. */
static inline double imp_body_energy(const imp_body *body, const imp_state *state, qvec3 g)
{
    return body->mass * (0.5 * qvec3_dot(state->v, state->v) - qvec3_dot(g, state->x)) +
           0.5 * qvec3_dot(state->momentum, imp_omega(body, state));
}

/* Velocity of a static body's surface at r from its centre. */
static inline qvec3 imp_surface_velocity(const imp_body *body, qvec3 r)
{
    return body->driven ? qvec3_add(body->drift, qvec3_cross(body->spin, r)) : (qvec3){0, 0, 0};
}

/* Velocity of the body's point at r from its centre. */
static inline qvec3 imp_point_velocity(const imp_body *body, const imp_state *state, qvec3 r)
{
    return body->is_static ? imp_surface_velocity(body, r)
                           : qvec3_add(state->v, qvec3_cross(imp_omega(body, state), r));
}

/* The body that much time (s) later or earlier, as it moves now. */
static inline imp_state imp_drifted(const imp_body *body, const imp_state *state, double time)
{
    imp_state then = *state;
    if (body->is_static) return then;
    const qvec3 turn = qvec3_scale(imp_omega(body, state), time);
    then.x = qvec3_axpy(time, state->v, state->x);
    (void)quat_normalize(quat_mul(quat_from_rotation_vector(turn), state->q), &then.q);
    return then;
}

/* The shape's axes to the world's. */
static inline quat imp_shape_axes(const imp_body *body, const imp_state *state)
{
    return body->shifted ? quat_mul(state->q, body->turn) : state->q;
}

/* The shape's centre from the body's, world. */
static inline qvec3 imp_shape_offset(const imp_body *body, const imp_state *state)
{
    return body->shifted ? quat_rotate(state->q, body->offset) : (qvec3){0, 0, 0};
}

/* A ball whose turning does not move its surface. */
static inline bool imp_is_ball(const imp_body *body) { return body->shape.kind == IMPACT_SPHERE && !body->shifted; }

static inline impact_solid imp_solid_of(const imp_body *body, const imp_state *state)
{
    return (impact_solid){body->shape, qvec3_add(state->x, imp_shape_offset(body, state)), imp_shape_axes(body, state)};
}

/* A rate, of motion at this speed, up to which a distance does not open, m/s: what only rounding moves stays where it
 * is. */
static inline double imp_still_rate(const imp_world *world, double speed)
{
    return world->slip_speed + IMP_STILL_OF_SPEED * speed;
}

#endif
