/* SPDX-License-Identifier: MIT
 *
 * Open Dynamics Engine as a peer of bench_crowd: a hash space, one contact of restitution 1 a pair, the direct solver.
 */
#include "peers_crowd.h"

#ifdef HAVE_ODE
#include <math.h>
#include <ode/ode.h>

typedef struct ode_gas {
    dWorldID world;
    dSpaceID space;
    dJointGroupID group;
    dBodyID *bodies;
} ode_gas;

static void meet_near(void *context, dGeomID one, dGeomID other)
{
    const ode_gas *o = context;
    dContact contact = {0};
    if (dCollide(one, other, 1, &contact.geom, sizeof contact) == 0) return;
    contact.surface.mode = dContactBounce;
    contact.surface.bounce = 1;
    dJointAttach(dJointCreateContact(o->world, o->group, &contact), dGeomGetBody(one), dGeomGetBody(other));
}

static void fill_world(ode_gas *o, const gas *g)
{
    for (int k = 0; k < 6; k++) {
        qvec3 x, n;
        crowd_wall(g, k, &x, &n);
        dCreatePlane(o->space, n.x, n.y, n.z, qvec3_dot(n, x));
    }
    for (int i = 0; i < g->count; i++) {
        dMass mass;
        dMassSetSphereTotal(&mass, crowd_mass(g->radius[i]), g->radius[i]);
        o->bodies[i] = dBodyCreate(o->world);
        dBodySetMass(o->bodies[i], &mass);
        dBodySetPosition(o->bodies[i], g->position[i].x, g->position[i].y, g->position[i].z);
        dBodySetLinearVel(o->bodies[i], g->velocity[i].x, g->velocity[i].y, g->velocity[i].z);
        dGeomSetBody(dCreateSphere(o->space, g->radius[i]), o->bodies[i]);
    }
}

static double ode_energy(const ode_gas *o, const gas *g)
{
    double energy = 0;
    for (int i = 0; i < g->count; i++) {
        const dReal *v = dBodyGetLinearVel(o->bodies[i]);
        energy += crowd_energy(g->radius[i], (qvec3){v[0], v[1], v[2]});
    }
    return energy;
}

bool crowd_ode(const gas *g, double duration, gas_run *run)
{
    ode_gas o = {.bodies = malloc((size_t)g->count * sizeof *o.bodies)};
    if (!o.bodies) return false;
    dInitODE2(0);
    o.world = dWorldCreate(), o.space = dHashSpaceCreate(0), o.group = dJointGroupCreate(0);
    dWorldSetCFM(o.world, 0);
    dWorldSetERP(o.world, 0); /* else the way out of an overlap adds energy */
    fill_world(&o, g);
    const double before = ode_energy(&o, g), from = crowd_clock();
    for (long k = 0; k < lrint(duration / crowd_step); k++) {
        dSpaceCollide(o.space, &o, meet_near);
        dWorldStep(o.world, crowd_step);
        dJointGroupEmpty(o.group);
    }
    *run = (gas_run){crowd_clock() - from, -1, ode_energy(&o, g) / before - 1, NAN};
    dJointGroupDestroy(o.group);
    dSpaceDestroy(o.space);
    dWorldDestroy(o.world);
    dCloseODE();
    free(o.bodies);
    return true;
}
#else
bool crowd_ode(const gas *g, double duration, gas_run *run) { return (void)g, (void)duration, (void)run, false; }
#endif
