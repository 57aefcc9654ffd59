/* SPDX-License-Identifier: MIT
 *
 * Writes tests/data/collide_slender.csv: impacts of slender bodies, their answers in 128 bits, and the true sensitivity
 * of the velocities: the largest of 24 changes of every number by 2^-30 of itself up or down, in 128 bits.
 *   cmake --build build --target generate_collide_slender && build/tests/generators/generate_collide_slender >
 * tests/data/collide_slender.csv
 * The oracle's own digits: a row stands only if the answer with the axes of the world permuted, for which the oracle
 * takes another frame, is the same to 2 units of the last of the 17 digits written.
 */
#include <stdio.h>
#include "collide_cases.h"
#include "collide_oracle.h"

enum { TRIES = 24 };

static void vector(qvec3 v) { printf(",%a,%a,%a", v.x, v.y, v.z); }
static void answer(qvec3 v) { printf(",%.17g,%.17g,%.17g", v.x, v.y, v.z); }

static void nudge(double *x, uint64_t *g) { *x += (case_random(g) < 0.5 ? -0x1p-30 : 0x1p-30) * *x; }

static void nudge3(qvec3 *v, uint64_t *g)
{
    nudge(&v->x, g);
    nudge(&v->y, g);
    nudge(&v->z, g);
}

static impact_collision nudged(impact_collision c, uint64_t *g)
{
    for (int i = 0; i < 2; i++) {
        impact_collider *b = &c.body[i];
        nudge3(&b->offset, g);
        nudge3(&b->velocity, g);
        nudge3(&b->omega, g);
        nudge3(&b->moments, g);
        nudge(&b->orientation.w, g);
        nudge(&b->orientation.x, g);
        nudge(&b->orientation.y, g);
        nudge(&b->orientation.z, g);
        if (isfinite(b->mass)) nudge(&b->mass, g);
    }
    nudge3(&c.normal, g);
    nudge(&c.friction, g);
    nudge(&c.restitution, g);
    return c;
}

/* 0: the oracle knows a change no answer to. */
static double sensitivity(const impact_collision *c, const oracle_outcome *exact)
{
    uint64_t g = 1;
    double worst = 0;
    for (int i = 0; i < TRIES; i++) {
        const impact_collision other = nudged(*c, &g);
        oracle_outcome moved;
        if (!oracle_collide(&other, &moved)) return 0;
        worst = fmax(worst, case_error(c, moved.velocity, moved.omega, exact->velocity, exact->omega));
    }
    return worst * 0x1p30;
}

static qvec3 permuted3(qvec3 v) { return (qvec3){v.y, v.z, v.x}; }

/* x, y, z become y, z, x, in the world and in the bodies: exact in double. */
static impact_collision permuted(impact_collision c)
{
    c.normal = permuted3(c.normal);
    for (int i = 0; i < 2; i++) {
        impact_collider *b = &c.body[i];
        const quat q = b->orientation;
        b->offset = permuted3(b->offset);
        b->velocity = permuted3(b->velocity);
        b->omega = permuted3(b->omega);
        b->moments = permuted3(b->moments);
        b->orientation = (quat){q.w, q.y, q.z, q.x};
    }
    return c;
}

static bool is_sure(const impact_collision *c, const oracle_outcome *exact)
{
    const impact_collision other = permuted(*c);
    oracle_outcome again;
    if (!oracle_collide(&other, &again)) return false;
    qvec3 v[2], w[2];
    for (int i = 0; i < 2; i++) {
        v[i] = permuted3(exact->velocity[i]);
        w[i] = permuted3(exact->omega[i]);
    }
    return case_error(&other, again.velocity, again.omega, v, w) <= 0x1p-51;
}

static bool row(double r, uint64_t index)
{
    const impact_collision c = case_slender(2026, index, r);
    oracle_outcome o;
    if (!oracle_collide(&c, &o) || !is_sure(&c, &o)) return false;
    const double s = sensitivity(&c, &o);
    if (s == 0) return false;
    printf("%g", r);
    for (int i = 0; i < 2; i++) {
        const impact_collider *b = &c.body[i];
        printf(",%a", b->mass);
        vector(b->moments);
        printf(",%a,%a,%a,%a", b->orientation.w, b->orientation.x, b->orientation.y, b->orientation.z);
        vector(b->offset);
        vector(b->velocity);
        vector(b->omega);
    }
    vector(c.normal);
    printf(",%a,%a,%d", c.friction, c.restitution, (int)c.law);
    for (int i = 0; i < 2; i++) {
        answer(o.velocity[i]);
        answer(o.omega[i]);
    }
    printf(",%.3g\n", s);
    fflush(stdout);
    return true;
}

int main(void)
{
    printf("r");
    for (int i = 1; i <= 2; i++)
        printf(",m%d,Jx%d,Jy%d,Jz%d,qw%d,qx%d,qy%d,qz%d,rx%d,ry%d,rz%d,vx%d,vy%d,vz%d,wx%d,wy%d,wz%d", i, i, i, i, i, i,
               i, i, i, i, i, i, i, i, i, i, i);
    printf(",nx,ny,nz,mu,eps,law");
    for (int i = 1; i <= 2; i++) printf(",Vx%d,Vy%d,Vz%d,Wx%d,Wy%d,Wz%d", i, i, i, i, i, i);
    printf(",sensitivity\n");
    for (int e = 1; e <= 9; e++)
        for (uint64_t i = 0, rows = 0; rows < 24; i++) rows += row(pow(10, -e), 100 * (uint64_t)e + i);
    return 0;
}
