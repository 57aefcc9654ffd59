/* SPDX-License-Identifier: MIT
 *
 * Writes tests/data/collide_slender.csv: impacts of slender bodies, their answers in 128 bits, and the sensitivity of
 * the velocities by differences in 128 bits: the root of the sum of squares over every number, changed by 2^-24 of
 * itself up and down. cmake --build build --target generate_collide_slender &&
 * build/tests/generators/generate_collide_slender > tests/data/collide_slender.csv The oracle's own digits: a row
 * stands only if the answer with the axes of the world permuted, for which the oracle takes another frame, is the same
 * to 2 units of the last of the 17 digits written.
 */
#include <math.h>
#include <stdio.h>
#include "collide_cases.h"
#include "collide_oracle.h"

enum { OF_BODY = 17, DATA = 2 * OF_BODY + 5 };

static void vector(qvec3 v) { printf(",%a,%a,%a", v.x, v.y, v.z); }
static void answer(qvec3 v) { printf(",%.17g,%.17g,%.17g", v.x, v.y, v.z); }

/* Number k of the data. */
static double *number_of(impact_collision *c, int k)
{
    impact_collider *b = &c->body[k / OF_BODY % 2];
    double *const body[OF_BODY] = {
        &b->mass,     &b->moments.x,     &b->moments.y,     &b->moments.z,     &b->offset.x,     &b->offset.y,
        &b->offset.z, &b->velocity.x,    &b->velocity.y,    &b->velocity.z,    &b->omega.x,      &b->omega.y,
        &b->omega.z,  &b->orientation.w, &b->orientation.x, &b->orientation.y, &b->orientation.z};
    double *const contact[] = {&c->normal.x, &c->normal.y, &c->normal.z, &c->friction, &c->restitution};
    return k < 2 * OF_BODY ? body[k % OF_BODY] : contact[k - 2 * OF_BODY];
}

/* NaN: the oracle knows a change no answer to. */
static double sensitivity(const impact_collision *c)
{
    const double by = 0x1p-24;
    double sum = 0;
    for (int k = 0; k < DATA; k++) {
        impact_collision up = *c, down = *c;
        oracle_outcome above, below;
        const double x = *number_of(&up, k);
        if (x == 0 || isinf(x)) continue;
        *number_of(&up, k) = x + by * x;
        *number_of(&down, k) = x - by * x;
        if (!oracle_collide(&up, &above) || !oracle_collide(&down, &below)) return NAN;
        const double moved = case_error(c, above.velocity, above.omega, below.velocity, below.omega) / (2 * by);
        sum += moved * moved;
    }
    return sqrt(sum);
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
    const double s = sensitivity(&c);
    if (isnan(s)) return false;
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
    printf(",%.6g\n", s);
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
