/* SPDX-License-Identifier: MIT
 *
 * Writes tests/data/collide_oracle.csv: impacts of every kind and their answers in 128 bits.
 *   cmake --build build --target generate_collide_oracle && build/tests/generators/generate_collide_oracle >
 * tests/data/collide_oracle.csv The library is asked only which random impacts are interesting (a slip, a stick, a
 * reversal, a jam ...), never for an answer.
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

typedef bool interesting(const impact_collision *c, const impact_outcome *o);

static bool has(const impact_outcome *o, impact_phase one, impact_phase other)
{
    for (int i = 0; i < o->phase_count; i++)
        if (o->phases[i] == one || o->phases[i] == other) return true;
    return false;
}
static bool any(const impact_collision *c, const impact_outcome *o) { return (void)c, (void)o, true; }
static bool reverses(const impact_collision *c, const impact_outcome *o)
{
    return (void)c, has(o, IMPACT_REVERSAL, IMPACT_REVERSAL);
}
static bool jams(const impact_collision *c, const impact_outcome *o) { return (void)c, o->jammed; }
static bool compresses_again(const impact_collision *c, const impact_outcome *o)
{
    return (void)c, o->compressions > 1;
}
static bool sticks(const impact_collision *c, const impact_outcome *o)
{
    return (void)c, has(o, IMPACT_STICK_C, IMPACT_STICK_R);
}
static bool slips(const impact_collision *c, const impact_outcome *o)
{
    return (void)c, !has(o, IMPACT_STICK_C, IMPACT_STICK_R) && !has(o, IMPACT_REVERSAL, IMPACT_REVERSAL);
}
static bool is_plastic(const impact_collision *c, const impact_outcome *o) { return (void)o, c->restitution == 0; }
static bool is_elastic(const impact_collision *c, const impact_outcome *o) { return (void)o, c->restitution == 1; }

/* Light on heavy or heavy on light, and slippery or rough, beyond what `wild` mostly draws. */
static bool is_far_off(const impact_collision *c, const impact_outcome *o)
{
    (void)o;
    const double ratio = c->body[0].mass / c->body[1].mass;
    return isfinite(ratio) && ratio > 0 && fabs(log10(ratio)) > 6 && fabs(log10(c->friction)) > 2;
}

/* The name is the file's and the class'; the laws in turn. */
static void pick(const char *name, case_class class_, int wanted, interesting *which)
{
    char full[32];
    snprintf(full, sizeof full, "%s %s", case_name(class_), name);
    for (uint64_t i = 0; wanted > 0; i++) {
        const impact_collision c = case_make(class_, 2026, i);
        impact_outcome o;
        if (which != any && (impact_collide(&c, &o) != IMPACT_OK || !which(&c, &o))) continue;
        if (row(*name ? full : case_name(class_), &c)) wanted--;
    }
}

int main(void)
{
    heading();
    for (int i = 0; i < 2; i++) {
        const impact_collision ellipsoid = scene_ellipsoid(i), one = scene_sphere(i == 1),
                               two = scene_two_spheres(i == 1);
        if (!row(i == 0 ? "S5a" : "S5b", &ellipsoid)) return 1;
        if (!row(i == 0 ? "S1a" : "S1b", &one) || !row(i == 0 ? "S2a" : "S2b", &two)) return 1;
    }
    for (int k = 0; k < CASE_CLASSES; k++) pick("", (case_class)k, 24, any);
    pick("far off", CASE_WILD, 12, is_far_off);
    pick("plastic", CASE_WILD, 6, is_plastic);
    pick("elastic", CASE_WILD, 6, is_elastic);
    const case_class sliding[] = {CASE_ROD, CASE_PLANAR, CASE_SPHERE, CASE_ISOTROPIC, CASE_TANGENT};
    for (int k = 0; k < 5; k++) {
        pick("slip", sliding[k], 6, slips);
        pick("stick", sliding[k], 6, sticks);
    }
    const case_class turning[] = {CASE_ROD, CASE_PLANAR, CASE_TILTED, CASE_TANGENT};
    for (int k = 0; k < 4; k++) pick("reversal", turning[k], 6, reverses);
    const case_class jamming[] = {CASE_WILD, CASE_ROD, CASE_PLANAR, CASE_ISOTROPIC, CASE_TILTED};
    for (int k = 0; k < 5; k++) pick("jam", jamming[k], 6, jams);
    const case_class twice[] = {CASE_ROD, CASE_WILD, CASE_ISOTROPIC};
    for (int k = 0; k < 3; k++) pick("recompression", twice[k], 6, compresses_again);
    return 0;
}
