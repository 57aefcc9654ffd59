/* SPDX-License-Identifier: MIT
 *
 * Bullet in double precision as a peer of bench_crowd: its dynamic tree, sequential impulses, restitution 1.
 */
#include "peers_crowd.h"

#ifdef HAVE_BULLET
#define BT_USE_DOUBLE_PRECISION
#include <btBulletDynamicsCommon.h>
#include <cmath>
#include <memory>
#include <vector>

extern btScalar gContactBreakingThreshold;

namespace
{

struct bullet_gas {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld dynamics{&dispatcher, &broadphase, &solver, &configuration};
    std::vector<std::unique_ptr<btCollisionShape>> shapes;
    std::vector<std::unique_ptr<btRigidBody>> bodies;

    explicit bullet_gas(const gas &g)
    {
        dynamics.setGravity(btVector3(0, 0, 0));
        btContactSolverInfo &info = dynamics.getSolverInfo();
        info.m_restitutionVelocityThreshold = 0;
        info.m_erp = info.m_erp2 = 0;     /* else the way out of an overlap adds energy */
        gContactBreakingThreshold = 1e-9; /* else it brakes ahead of contact, and restitution is lost */
        for (int i = 0; i < g.count; i++) {
            const double mass = crowd_mass(g.radius[i]), j = 0.4 * mass * g.radius[i] * g.radius[i];
            btRigidBody *body = add(new btSphereShape(g.radius[i]), mass, btVector3(j, j, j));
            const qvec3 x = g.position[i], v = g.velocity[i];
            body->setCenterOfMassTransform(btTransform(btQuaternion::getIdentity(), btVector3(x.x, x.y, x.z)));
            body->setLinearVelocity(btVector3(v.x, v.y, v.z));
        }
        for (int k = 0; k < 6; k++) {
            qvec3 x, n;
            crowd_wall(&g, k, &x, &n);
            add(new btStaticPlaneShape(btVector3(n.x, n.y, n.z), qvec3_dot(n, x)), 0, btVector3(0, 0, 0));
        }
    }
    ~bullet_gas()
    {
        for (auto &body : bodies) dynamics.removeRigidBody(body.get());
    }
    btRigidBody *add(btCollisionShape *shape, double mass, const btVector3 &moments)
    {
        shapes.emplace_back(shape);
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, moments);
        info.m_linearDamping = info.m_angularDamping = info.m_friction = 0;
        info.m_restitution = 1;
        bodies.push_back(std::make_unique<btRigidBody>(info));
        bodies.back()->setActivationState(DISABLE_DEACTIVATION);
        dynamics.addRigidBody(bodies.back().get());
        return bodies.back().get();
    }
    double energy(const gas &g) const
    {
        double sum = 0;
        for (int i = 0; i < g.count; i++) {
            const btVector3 v = bodies[static_cast<size_t>(i)]->getLinearVelocity();
            sum += crowd_energy(g.radius[i], qvec3_make(v.x(), v.y(), v.z()));
        }
        return sum;
    }
};

} // namespace

extern "C" bool crowd_bullet(const gas *g, double duration, gas_run *run)
{
    const auto world = std::make_unique<bullet_gas>(*g);
    const double before = world->energy(*g), from = crowd_clock();
    for (long k = 0; k < std::lrint(duration / crowd_step); k++) world->dynamics.stepSimulation(crowd_step, 0);
    *run = gas_run{crowd_clock() - from, -1, world->energy(*g) / before - 1, NAN};
    return true;
}
#else
extern "C" bool crowd_bullet(const gas *, double, gas_run *) { return false; }
#endif
