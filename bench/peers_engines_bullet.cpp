/* SPDX-License-Identifier: MIT
 *
 * Bullet in double precision as a peer: its sequential impulses to convergence, for one impact on the exact contact.
 */
#include "peers_engines.h"

#ifdef HAVE_BULLET
#define BT_USE_DOUBLE_PRECISION
#include <btBulletDynamicsCommon.h>
#include <memory>

extern btScalar gContactBreakingThreshold;

namespace
{

btVector3 vector(qvec3 v) { return btVector3(v.x, v.y, v.z); }
qvec3 vector_of(const btVector3 &v) { return qvec3_make(v.x(), v.y(), v.z()); }
bool infinite(const impact_collider &b) { return std::isinf(b.mass); }

std::unique_ptr<btRigidBody> make_body(double mass, qvec3 moments, btCollisionShape *shape)
{
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, vector(moments));
    info.m_linearDamping = info.m_angularDamping = 0;
    auto body = std::make_unique<btRigidBody>(info);
    body->setActivationState(DISABLE_DEACTIVATION);
    body->setFlags(0);
    return body;
}

/* A world of which one may take the parts. */
struct world {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld dynamics{&dispatcher, &broadphase, &solver, &configuration};

    explicit world(double gravity)
    {
        dynamics.setGravity(btVector3(0, 0, -gravity));
        settle(dynamics.getSolverInfo());
        gContactBreakingThreshold = 1e-9; /* else it brakes ahead of contact, and restitution is lost */
    }
    static void settle(btContactSolverInfo &info)
    {
        info.m_numIterations = 200;
        info.m_restitutionVelocityThreshold = 0;
        info.m_solverMode = SOLVER_USE_2_FRICTION_DIRECTIONS;
        info.m_erp = info.m_erp2 = 0; /* else the way out of the floor adds energy */
    }
};

bool impact(const impact_collision *c, double step, qvec3 v[2], qvec3 w[2], double *seconds)
{
    world world(0);
    btSphereShape shape(1);
    std::unique_ptr<btRigidBody> own[2];
    btCollisionObject *bodies[2];
    for (int i = 0; i < 2; i++) {
        const impact_collider &b = c->body[i];
        own[i] = make_body(infinite(b) ? 0 : b.mass, b.moments, &shape);
        const btQuaternion q(b.orientation.x, b.orientation.y, b.orientation.z, b.orientation.w);
        own[i]->setCenterOfMassTransform(btTransform(q, -vector(b.offset)));
        if (!infinite(b)) {
            own[i]->setLinearVelocity(vector(b.velocity));
            own[i]->setAngularVelocity(vector(b.omega));
        }
        bodies[i] = own[i].get();
    }
    btPersistentManifold *manifold = world.dispatcher.getNewManifold(bodies[0], bodies[1]);
    btManifoldPoint point(own[0]->getCenterOfMassTransform().inverse() * btVector3(0, 0, 0),
                          own[1]->getCenterOfMassTransform().inverse() * btVector3(0, 0, 0), vector(c->normal), 0);
    point.m_combinedFriction = c->friction;
    point.m_combinedRestitution = c->restitution;
    manifold->addManifoldPoint(point);
    btContactSolverInfo info;
    world::settle(info);
    info.m_timeStep = step;
    const double from = measure_clock();
    world.solver.solveGroup(bodies, 2, &manifold, 1, nullptr, 0, info, nullptr, &world.dispatcher);
    *seconds = measure_since(from);
    for (int i = 0; i < 2; i++) {
        v[i] = vector_of(own[i]->getLinearVelocity());
        w[i] = vector_of(own[i]->getAngularVelocity());
    }
    world.dispatcher.releaseManifold(manifold);
    return true;
}

bool bounce(const bounce_case *c, double step, double height[BOUNCES], double *seconds)
{
    world world(c->gravity);
    btSphereShape sphere(c->radius);
    btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
    const double j = 0.4 * c->mass * c->radius * c->radius;
    auto ball = make_body(c->mass, qvec3_make(j, j, j), &sphere), floor = make_body(0, qvec3_make(0, 0, 0), &plane);
    ball->setCenterOfMassTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, c->height + c->radius)));
    ball->setRestitution(c->restitution);
    floor->setRestitution(1);
    world.dynamics.addRigidBody(ball.get());
    world.dynamics.addRigidBody(floor.get());
    bounce_watch watch = {0, 0};
    const double from = measure_clock();
    for (double t = 0; t < c->duration; t += step) {
        world.dynamics.stepSimulation(step, 0);
        bounce_look(&watch, c, ball->getCenterOfMassPosition().z(), ball->getLinearVelocity().z(), height);
    }
    *seconds = measure_since(from);
    world.dynamics.removeRigidBody(ball.get());
    world.dynamics.removeRigidBody(floor.get());
    return watch.bounces == BOUNCES;
}

bool tumble(const tumble_case *c, double step, quat q[TURNS], double *seconds)
{
    world world(0);
    btSphereShape shape(1);
    auto body = make_body(c->mass, c->moments, &shape);
    body->setFlags(BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY);
    body->setAngularVelocity(vector(c->omega));
    world.dynamics.addRigidBody(body.get());
    const int steps = (int)std::lrint(1 / step);
    const double from = measure_clock();
    for (int second = 0; second < tumble_seconds(); second++) {
        for (int k = 0; k < steps; k++) world.dynamics.stepSimulation(step, 0);
        const btQuaternion r = body->getOrientation();
        q[second] = quat_make(r.w(), r.x(), r.y(), r.z());
    }
    *seconds = measure_since(from);
    world.dynamics.removeRigidBody(body.get());
    return true;
}

} // namespace

extern "C" const engine engines_bullet[] = {
    {"Bullet", 1e-2, impact, bounce, tumble}, {"Bullet", 1e-3, impact, bounce, tumble},
    {"Bullet", 1e-4, impact, bounce, tumble}, {"Bullet", 1e-5, impact, bounce, tumble},
    {nullptr, 0, nullptr, nullptr, nullptr},
};
#else
extern "C" const engine engines_bullet[] = {{nullptr, 0, nullptr, nullptr, nullptr}};
#endif
