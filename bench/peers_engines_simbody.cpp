// SPDX-License-Identifier: MIT
//
// Simbody as a peer: its semi-explicit time stepper with a unilateral contact for bounces, its Runge-Kutta-Merson
// integrator with error control for a body that turns freely. It has no call for one impact alone. Debian's build tells
// every iteration of its impulse solver, by C++'s streams and by C's printf: both take nothing meanwhile.
#include "peers_engines.h"

#ifdef HAVE_SIMBODY
#include <cstdio>
#include <fcntl.h>
#include <iostream>
#include <Simbody.h>
#include <unistd.h>

namespace
{

// The standard streams take nothing while it lives: C++'s are shut, and what C's write goes to /dev/null, not among the
// rows of this program.
class Silence
{
    int kept;

    static void point(int from)
    {
        std::fflush(stdout);
        dup2(from, STDOUT_FILENO);
        close(from);
    }

  public:
    Silence() : kept(dup(STDOUT_FILENO))
    {
        for (std::ostream *s : {&std::cout, &std::cerr, &std::clog}) s->setstate(std::ios_base::failbit);
        point(open("/dev/null", O_WRONLY));
    }
    ~Silence()
    {
        point(kept);
        for (std::ostream *s : {&std::cout, &std::cerr, &std::clog}) s->clear();
    }
};

bool bounce(const bounce_case *c, double step, double height[BOUNCES], double *seconds)
{
    using namespace SimTK;
    MultibodySystem system;
    SimbodyMatterSubsystem matter(system);
    GeneralForceSubsystem forces(system);
    Force::Gravity gravity(forces, matter, -ZAxis, c->gravity);
    MobilizedBody::Free ball(matter.Ground(), Transform(),
                             Body::Rigid(MassProperties(c->mass, Vec3(0), UnitInertia::sphere(c->radius) * c->mass)),
                             Transform());
    MobilizedBody ground = matter.Ground();
    matter.adoptUnilateralContact(
        new SpherePlaneContact(ground, ZAxis, 0, ball, Vec3(0), c->radius, c->restitution, 0, 0, 0));
    State state = system.realizeTopology();
    system.realizeModel(state);
    ball.setQToFitTranslation(state, Vec3(0, 0, c->height + c->radius));
    SemiExplicitEulerTimeStepper stepper(system);
    stepper.setDefaultImpactCaptureVelocity(0);
    stepper.setDefaultImpactMinCORVelocity(0);
    const Silence silence;
    stepper.initialize(state);
    bounce_watch watch = {0, 0};
    const double from = measure_clock();
    for (int k = 1; k * step <= c->duration; k++) {
        stepper.stepTo(k * step);
        const State &s = stepper.getState();
        system.realize(s, Stage::Velocity);
        bounce_look(&watch, c, ball.getBodyOriginLocation(s)[2], ball.getBodyOriginVelocity(s)[2], height);
    }
    *seconds = measure_since(from);
    return watch.bounces == BOUNCES;
}

bool tumble(const tumble_case *c, double accuracy, quat q[TURNS], double *seconds)
{
    using namespace SimTK;
    MultibodySystem system;
    SimbodyMatterSubsystem matter(system);
    MobilizedBody::Free body(
        matter.Ground(), Transform(),
        Body::Rigid(MassProperties(c->mass, Vec3(0), Inertia(c->moments.x, c->moments.y, c->moments.z))), Transform());
    State state = system.realizeTopology();
    system.realizeModel(state);
    body.setUToFitAngularVelocity(state, Vec3(c->omega.x, c->omega.y, c->omega.z));
    RungeKuttaMersonIntegrator integrator(system);
    integrator.setAccuracy(accuracy);
    integrator.initialize(state);
    const double from = measure_clock();
    for (int second = 0; second < tumble_seconds(); second++) {
        while (integrator.getTime() < second + 1) integrator.stepTo(second + 1); // the first call stands still
        const Vec4 r = body.getBodyRotation(integrator.getState()).convertRotationToQuaternion().asVec4();
        q[second] = quat{r[0], r[1], r[2], r[3]};
    }
    *seconds = measure_since(from);
    return true;
}

} // namespace

extern "C" const engine engines_simbody[] = {
    {"Simbody", 1e-2, nullptr, bounce, nullptr}, {"Simbody", 1e-3, nullptr, bounce, nullptr},
    {"Simbody", 1e-4, nullptr, bounce, nullptr}, {"Simbody", 1e-4, nullptr, nullptr, tumble},
    {"Simbody", 1e-7, nullptr, nullptr, tumble}, {"Simbody", 1e-10, nullptr, nullptr, tumble},
    {nullptr, 0, nullptr, nullptr, nullptr},
};
#else
extern "C" const engine engines_simbody[] = {{nullptr, 0, nullptr, nullptr, nullptr}};
#endif
