/* SPDX-License-Identifier: MIT */
#include "truth_lean.h"

#include <math.h>

/* The state at the impact, just after it: theta, and theta'^2 at any theta from there on. */
typedef struct press {
    double s, theta0, theta1, energy, t0; /* energy: over m2 */
    double share;                         /* m1/(m1 + m2) */
    double gravity;
} press;

/* (theta')^2, of energy and momentum. */
static double square(const press *p, double theta)
{
    const double sine = sin(theta), cosine = cos(theta);
    return 2 * (p->energy - p->gravity * p->s * sine) / (p->s * p->s * (p->share * sine * sine + cosine * cosine));
}

/* The light one goes away at (1 - share) s sin(theta) |theta'|: the derivative by theta of its square. */
static double push(const press *p, double theta)
{
    const double sine = sin(theta), cosine = cos(theta), s2 = p->s * p->s,
                 inertia = s2 * (p->share * sine * sine + cosine * cosine), left = p->energy - p->gravity * p->s * sine;
    const double inertia_rate = 2 * s2 * sine * cosine * (p->share - 1);
    return 2 * sine * cosine * left * inertia - p->gravity * p->s * cosine * sine * sine * inertia -
           sine * sine * left * inertia_rate;
}

static press pressing(const truth_lean *l)
{
    const double s = 2 * l->radius, above = sqrt(s * s - l->away * l->away), fallen = l->above - above;
    press p = {.s = s, .share = l->light / (l->light + l->heavy), .gravity = l->gravity};
    p.theta0 = atan2(above, l->away);
    p.t0 = sqrt(2 * fallen / l->gravity);
    /* Along the line the relative speed ends: n.(v2 - P/m2 n) + P cos^2/m1 = 0 of v2 = (0, -v). */
    const double v = l->gravity * p.t0, sine = sin(p.theta0), cosine = cos(p.theta0);
    const double P = v * sine / (1 / l->heavy + cosine * cosine / l->light);
    const double x2 = P * cosine / l->heavy, z2 = -v + P * sine / l->heavy, x1 = -P * cosine / l->light;
    p.energy = (x2 * x2 + z2 * z2 + l->light / l->heavy * x1 * x1) / 2 + l->gravity * above;
    double low = 1e-9, high = p.theta0; /* pushed at high: its speed still grows as theta falls */
    for (int i = 0; i < 200 && push(&p, high) < 0; i++) {
        const double middle = low + (high - low) / 2;
        if (middle <= low || middle >= high) break;
        if (push(&p, middle) < 0)
            high = middle;
        else
            low = middle;
    }
    p.theta1 = push(&p, p.theta0) < 0 ? high : p.theta0;
    return p;
}

/* Gauss' rule of 5 points on 64 pieces of t = integral of 1/|theta'| from theta0 down to theta. */
static double time_to(const press *p, double theta)
{
    static const double node[5] = {-.906179845938663992797626878299, -.538469310105683091036314420700, 0,
                                   .538469310105683091036314420700, .906179845938663992797626878299};
    static const double weight[5] = {.236926885056189087514264040720, .478628670499366468041291514836,
                                     .568888888888888888888888888889, .478628670499366468041291514836,
                                     .236926885056189087514264040720};
    enum { PIECES = 64 };
    const double width = (p->theta0 - theta) / PIECES;
    double sum = 0;
    for (int k = 0; k < PIECES; k++)
        for (int i = 0; i < 5; i++)
            sum += weight[i] * width / 2 / sqrt(square(p, theta + width * (k + (1 + node[i]) / 2)));
    return p->t0 + sum;
}

static void place(const truth_lean *l, const press *p, double theta, double *light, double *heavy, double *above)
{
    const double closer = l->away - p->s * cos(theta); /* of the one to the other; their centre of mass stands */
    *light = (1 - p->share) * closer;
    *heavy = l->away - p->share * closer;
    *above = p->s * sin(theta);
}

void truth_lean_pressing(const truth_lean *l, double part, double *t, double *light, double *heavy, double *above)
{
    const press p = pressing(l);
    const double theta = p.theta0 + part * (p.theta1 - p.theta0);
    *t = time_to(&p, theta);
    place(l, &p, theta, light, heavy, above);
}

/* At the parting: t, and how fast. */
static double parting(const truth_lean *l, const press *p, double speed[3])
{
    const double rate = sqrt(square(p, p->theta1)), closer = -p->s * sin(p->theta1) * rate;
    (void)l;
    speed[0] = (1 - p->share) * closer, speed[1] = -p->share * closer, speed[2] = -p->s * cos(p->theta1) * rate;
    return time_to(p, p->theta1);
}

void truth_lean_apart(const truth_lean *l, double t, double *light, double *heavy, double *above)
{
    const press p = pressing(l);
    double speed[3];
    const double left = t - parting(l, &p, speed);
    place(l, &p, p.theta1, light, heavy, above);
    *light += speed[0] * left;
    *heavy += speed[1] * left;
    *above += left * (speed[2] - l->gravity * left / 2);
}

truth_lean_times truth_lean_events(const truth_lean *l)
{
    const press p = pressing(l);
    double speed[3], light, heavy, above;
    const double t = parting(l, &p, speed);
    place(l, &p, p.theta1, &light, &heavy, &above);
    return (truth_lean_times){p.t0, t,
                              t + (speed[2] + sqrt(speed[2] * speed[2] + 2 * l->gravity * above)) / l->gravity};
}
