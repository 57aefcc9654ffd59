/* SPDX-License-Identifier: MIT
 *
 * Writes tests/data/collide_oracle.csv: impacts and their answers by the closed hodograph in 128 bits.
 *   cmake --build build --target generate_collide_oracle && build/tests/generators/generate_collide_oracle > tests/data/collide_oracle.csv
 * The library is asked only which random impacts are interesting (reversal, jam, second compression), never for an answer.
 */
#include <stdio.h>
#include "collide_cases.h"
#include "collide_oracle.h"
#include "collide_scenes.h"

static void vector(qvec3 v) { printf(",%a,%a,%a", v.x, v.y, v.z); }
static void answer(qvec3 v) { printf(",%.17g,%.17g,%.17g", v.x, v.y, v.z); }

static bool row(const char *name, const impact_collision *c)
{
    oracle_outcome o;
    if (!oracle_collide(c, &o)) return false;
    printf("%s", name);
    for (int i = 0; i < 2; i++) {
        const impact_collider *b = &c->body[i];
        printf(",%a", b->mass);
        vector(b->moments);
        printf(",%a,%a,%a,%a", b->orientation.w, b->orientation.x, b->orientation.y, b->orientation.z);
        vector(b->offset);
        vector(b->velocity);
        vector(b->omega);
    }
    vector(c->normal);
    printf(",%a,%a,%d", c->friction, c->restitution, (int)c->law);
    for (int i = 0; i < 2; i++) {
        answer(o.velocity[i]);
        answer(o.omega[i]);
    }
    answer(o.impulse);
    printf(",%.17g,%.17g,%.17g,%.17g,%d\n", o.compression_impulse, o.work_compression, o.work_restitution,
           o.work_friction, o.compressions);
    fflush(stdout);
    return true;
}

static void heading(void)
{
    printf("name");
    for (int i = 1; i <= 2; i++)
        printf(",m%d,Jx%d,Jy%d,Jz%d,qw%d,qx%d,qy%d,qz%d,rx%d,ry%d,rz%d,vx%d,vy%d,vz%d,wx%d,wy%d,wz%d", i, i, i, i, i, i,
               i, i, i, i, i, i, i, i, i, i, i);
    printf(",nx,ny,nz,mu,eps,law");
    for (int i = 1; i <= 2; i++) printf(",Vx%d,Vy%d,Vz%d,Wx%d,Wy%d,Wz%d", i, i, i, i, i, i);
    printf(",Px,Py,Pz,p_c,W_c,W_r,W_f,compressions\n");
}

typedef bool interesting(const impact_outcome *o);

static bool reverses(const impact_outcome *o)
{
    for (int i = 0; i < o->phase_count; i++)
        if (o->phases[i] == IMPACT_REVERSAL) return true;
    return false;
}
static bool jams(const impact_outcome *o) { return o->jammed; }
static bool compresses_again(const impact_outcome *o) { return o->compressions > 1; }

static void pick(const char *name, case_class class_, int wanted, interesting *which)
{
    for (uint64_t i = 0; wanted > 0; i++) {
        const impact_collision c = case_make(class_, 2026, i);
        impact_outcome o;
        if (which && (impact_collide(&c, &o) != IMPACT_OK || !which(&o))) continue;
        if (row(name, &c)) wanted--;
    }
}

int main(void)
{
    heading();
    for (int i = 0; i < 2; i++) {
        const impact_collision c = scene_ellipsoid(i);
        if (!row(i == 0 ? "S5a" : "S5b", &c)) return 1;
    }
    const case_class classes[] = {CASE_PLAIN, CASE_WILD, CASE_ROD, CASE_TANGENT};
    for (int i = 0; i < 4; i++) pick(case_name(classes[i]), classes[i], 24, NULL);
    pick("reversal", CASE_ROD, 8, reverses);
    pick("jam", CASE_WILD, 8, jams);
    pick("recompression", CASE_ROD, 8, compresses_again);
    return 0;
}
