/* SPDX-License-Identifier: MIT
 *
 * Bullet in double precision: sequential impulses over all contacts of the line, from their exact points and normals.
 */
#include "peers_together.h"

#ifdef HAVE_BULLET
#define BT_USE_DOUBLE_PRECISION
#include <btBulletDynamicsCommon.h>
#include <memory>
#include <vector>
#include "measure.h"

extern "C" bool bullet_line(int n, int iterations, double *speed, double *seconds)
{
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btSequentialImpulseConstraintSolver solver;
    btSphereShape shape(1);
    std::vector<std::unique_ptr<btRigidBody>> balls;
    std::vector<btCollisionObject *> bodies;
    std::vector<btPersistentManifold *> manifolds;
    for (int i = 0; i < n; i++) {
        btRigidBody::btRigidBodyConstructionInfo info(1, nullptr, &shape, btVector3(0.4, 0.4, 0.4));
        balls.push_back(std::make_unique<btRigidBody>(info));
        balls[i]->setCenterOfMassTransform(btTransform(btQuaternion::getIdentity(), btVector3(2 * i, 0, 0)));
        balls[i]->setLinearVelocity(btVector3(i == 0, 0, 0));
        bodies.push_back(balls[i].get());
    }
    for (int i = 0; i + 1 < n; i++) {
        manifolds.push_back(dispatcher.getNewManifold(bodies[i], bodies[i + 1]));
        btManifoldPoint point(btVector3(1, 0, 0), btVector3(-1, 0, 0), btVector3(-1, 0, 0), 0);
        point.m_combinedFriction = 0;
        point.m_combinedRestitution = 1;
        manifolds[i]->addManifoldPoint(point);
    }
    btContactSolverInfo info;
    info.m_numIterations = iterations;
    info.m_restitutionVelocityThreshold = 0;
    info.m_erp = info.m_erp2 = 0;
    info.m_timeStep = 1e-3;
    const double from = measure_clock();
    solver.solveGroup(bodies.data(), n, manifolds.data(), n - 1, nullptr, 0, info, nullptr, &dispatcher);
    *seconds = measure_clock() - from;
    for (int i = 0; i < n; i++) speed[i] = balls[i]->getLinearVelocity().x();
    for (btPersistentManifold *manifold : manifolds) dispatcher.releaseManifold(manifold);
    return true;
}
#else
extern "C" bool bullet_line(int, int, double *, double *) { return false; }
#endif
