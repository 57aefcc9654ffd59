/* SPDX-License-Identifier: MIT
 *
 * Open Dynamics Engine as a peer: its direct solver (dWorldStep), no softening, the friction pyramid laid along the
 * slip.
 */
#include "peers_engines.h"

#ifdef HAVE_ODE
#include <ode/ode.h>

static dWorldID make_world(double gravity)
{
    dInitODE2(0);
    dWorldID world = dWorldCreate();
    dWorldSetGravity(world, 0, 0, -gravity);
    dWorldSetCFM(world, 0);
    return world;
}

static void end_world(dWorldID world)
{
    dWorldDestroy(world);
    dCloseODE();
}

static dBodyID make_body(dWorldID world, double mass, qvec3 moments)
{
    dBodyID body = dBodyCreate(world);
    dMass m;
    dMassSetParameters(&m, mass, 0, 0, 0, moments.x, moments.y, moments.z, 0, 0, 0);
    dBodySetMass(body, &m);
    dBodySetAutoDisableFlag(body, 0);
    return body;
}

static qvec3 vector_of(const dReal *v) { return (qvec3){v[0], v[1], v[2]}; }

static bool impact(const impact_collision *c, double step, qvec3 v[2], qvec3 w[2], double *seconds)
{
    dWorldID world = make_world(0);
    dBodyID body[2] = {0, 0};
    dContact contact = {0};
    qvec3 u = {0, 0, 0};
    for (int i = 0; i < 2; i++) {
        const impact_collider *b = &c->body[i];
        u = qvec3_axpy(i == 0 ? 1 : -1, qvec3_add(b->velocity, qvec3_cross(b->omega, b->offset)), u);
        if (isinf(b->mass)) continue;
        body[i] = make_body(world, b->mass, b->moments);
        const dReal q[4] = {b->orientation.w, b->orientation.x, b->orientation.y, b->orientation.z};
        dBodySetPosition(body[i], -b->offset.x, -b->offset.y, -b->offset.z);
        dBodySetQuaternion(body[i], q);
        dBodySetLinearVel(body[i], b->velocity.x, b->velocity.y, b->velocity.z);
        dBodySetAngularVel(body[i], b->omega.x, b->omega.y, b->omega.z);
        dBodySetGyroscopicMode(body[i], 0); /* the impact takes no time */
    }
    const qvec3 slip = qvec3_axpy(-qvec3_dot(u, c->normal), c->normal, u);
    const double s = qvec3_norm(slip);
    contact.surface.mode = dContactBounce | dContactApprox1 | (s > 0 ? dContactFDir1 : 0);
    contact.surface.mu = c->friction;
    contact.surface.bounce = c->restitution;
    contact.geom.normal[0] = c->normal.x, contact.geom.normal[1] = c->normal.y, contact.geom.normal[2] = c->normal.z;
    if (s > 0) contact.fdir1[0] = slip.x / s, contact.fdir1[1] = slip.y / s, contact.fdir1[2] = slip.z / s;
    dJointGroupID group = dJointGroupCreate(0);
    const double from = measure_clock();
    dJointAttach(dJointCreateContact(world, group, &contact), body[0], body[1]);
    const bool done = dWorldStep(world, step) != 0;
    *seconds = measure_since(from);
    for (int i = 0; i < 2; i++) {
        v[i] = body[i] ? vector_of(dBodyGetLinearVel(body[i])) : c->body[i].velocity;
        w[i] = body[i] ? vector_of(dBodyGetAngularVel(body[i])) : c->body[i].omega;
    }
    dJointGroupDestroy(group);
    end_world(world);
    return done;
}

typedef struct bouncing {
    dWorldID world;
    dJointGroupID group;
    double restitution;
} bouncing;

static void near(void *context, dGeomID one, dGeomID other)
{
    const bouncing *b = context;
    dContact contact = {0};
    if (dCollide(one, other, 1, &contact.geom, sizeof contact) == 0) return;
    contact.surface.mode = dContactBounce;
    contact.surface.bounce = b->restitution;
    dJointAttach(dJointCreateContact(b->world, b->group, &contact), dGeomGetBody(contact.geom.g1),
                 dGeomGetBody(contact.geom.g2));
}

static bool bounce(const bounce_case *c, double step, double height[BOUNCES], double *seconds)
{
    dWorldID world = make_world(c->gravity);
    dSpaceID space = dSimpleSpaceCreate(0);
    bouncing b = {world, dJointGroupCreate(0), c->restitution};
    const double j = 0.4 * c->mass * c->radius * c->radius;
    dBodyID ball = make_body(world, c->mass, (qvec3){j, j, j});
    dBodySetPosition(ball, 0, 0, c->height + c->radius);
    dGeomSetBody(dCreateSphere(space, c->radius), ball);
    dCreatePlane(space, 0, 0, 1, 0);
    bounce_watch watch = {0, 0};
    const double from = measure_clock();
    for (double t = 0; t < c->duration; t += step) {
        dSpaceCollide(space, &b, near);
        dWorldStep(world, step);
        dJointGroupEmpty(b.group);
        bounce_look(&watch, c, dBodyGetPosition(ball)[2], dBodyGetLinearVel(ball)[2], height);
    }
    *seconds = measure_since(from);
    dJointGroupDestroy(b.group);
    dSpaceDestroy(space);
    end_world(world);
    return watch.bounces == BOUNCES;
}

static bool tumble(const tumble_case *c, double step, quat q[TURNS], double *seconds)
{
    dWorldID world = make_world(0);
    dBodyID body = make_body(world, c->mass, c->moments);
    dBodySetAngularVel(body, c->omega.x, c->omega.y, c->omega.z);
    dBodySetFiniteRotationMode(body, 1);
    const int steps = (int)lrint(1 / step);
    const double from = measure_clock();
    for (int second = 0; second < tumble_seconds(); second++) {
        for (int k = 0; k < steps; k++) dWorldStep(world, step);
        const dReal *r = dBodyGetQuaternion(body);
        q[second] = (quat){r[0], r[1], r[2], r[3]};
    }
    *seconds = measure_since(from);
    end_world(world);
    return true;
}

const engine engines_ode[] = {
    {"ODE", 1e-2, impact, bounce, tumble}, {"ODE", 1e-3, impact, bounce, tumble}, {"ODE", 1e-4, impact, bounce, tumble},
    {"ODE", 1e-5, impact, bounce, tumble}, {NULL, 0, NULL, NULL, NULL},
};
#else
const engine engines_ode[] = {{NULL, 0, NULL, NULL, NULL}};
#endif
