/* SPDX-License-Identifier: MIT
 *
 * impact_collide on any collision: refused where impact_collide_check refuses; no NaN with an answer; momentum,
 * the cone, no approach left, no energy gained (Poisson, Stronge); the same with the bodies swapped.
 */
#include "fuzz.h"

#include <float.h>
#include <impact/collide.h>
#include <stdlib.h>

static impact_collision hit;
static double law_numbers[3];

static double law(double speed, void *context)
{
    const double *k = context;
    return k[0] + k[1] * exp(-speed * k[2]);
}

static void show_collider(FILE *out, int i, const impact_collider *c)
{
    fprintf(out, "    hit.body[%d] = (impact_collider){.mass = ", i);
    show_number(out, c->mass);
    show_vec3(out, ", .moments = ", c->moments);
    show_quat(out, ", .orientation = ", c->orientation);
    show_vec3(out, ",\n        .offset = ", c->offset);
    show_vec3(out, ", .velocity = ", c->velocity);
    show_vec3(out, ", .omega = ", c->omega);
    fputs("};\n", out);
}

void fuzz_show(FILE *out)
{
    fputs("#include <impact/impact.h>\n#include <math.h>\n#include <stdio.h>\n\n", out);
    if (hit.friction_law) {
        fprintf(out,
                "static double law(double speed, void *context)\n{\n    (void)context;\n    return %.17g + %.17g * ",
                law_numbers[0], law_numbers[1]);
        fprintf(out, "exp(-speed * %.17g);\n}\n\n", law_numbers[2]);
    }
    fputs("int main(void)\n{\n    impact_collision hit = {.friction = ", out);
    show_number(out, hit.friction);
    fputs(", .restitution = ", out);
    show_number(out, hit.restitution);
    fprintf(out, ", .law = (impact_law)%d, .solver = (impact_solver)%d, .series_order = %d", (int)hit.law,
            (int)hit.solver, hit.series_order);
    if (hit.friction_law) fputs(", .friction_law = law", out);
    fprintf(out, ", .tangential_compliance = %.17g", hit.tangential_compliance);
    show_vec3(out, ", .normal = ", hit.normal);
    fputs("};\n", out);
    for (int i = 0; i < 2; i++) show_collider(out, i, &hit.body[i]);
    fputs("    impact_outcome o;\n    const impact_status s = impact_collide(&hit, &o);\n"
          "    printf(\"%s: impulse %.17g, %.17g; u_n %.17g to %.17g; energy %.17g to %.17g\\n\", "
          "impact_status_string(s),\n"
          "           o.impulse_normal, o.impulse_tangential, o.normal_before, o.normal_after, o.energy_before,\n"
          "           o.energy_after);\n}\n",
          out);
}

/* Moments that keep the triangle inequality mostly. */
static impact_collider take_collider(fuzz_bytes *b, double span)
{
    impact_collider c = {.mass = take_byte(b) < 40 ? INFINITY : take_positive(b, span)};
    const double m = isfinite(c.mass) ? c.mass : 1, size = take_positive(b, span), x = take_positive(b, span);
    const double y = take_unit(b), first = m * size * size, second = first * fmin(x, 1e6), low = fabs(first - second);
    const double third = take_byte(b) < 200 ? low + y * (first + second - low) : first * take_positive(b, span);
    c.moments = (qvec3){first, second, third > 0 ? third : first};
    c.orientation = take_quat(b);
    c.offset = take_vec3(b, span);
    c.velocity = take_vec3(b, span);
    c.omega = take_vec3(b, span);
    return c;
}

static void take_collision(fuzz_bytes *b)
{
    static const double spans[] = {1, 3, 8, 20, 80, 150};
    const double span = spans[take_below(b, 6)];
    hit = (impact_collision){.body = {take_collider(b, span), take_collider(b, span)}};
    hit.normal = take_vec3(b, 2);
    hit.friction = take_byte(b) < 10 ? 0 : take_positive(b, 3);
    hit.restitution = take_unit(b);
    hit.law = (impact_law)take_below(b, 3);
    hit.solver = (impact_solver)(take_byte(b) < 230 ? 0 : take_below(b, 3));
    const unsigned extra = take_byte(b);
    for (int i = 0; i < 3; i++) law_numbers[i] = fabs(take_signed(b, i < 2 ? 1 : 2));
    if (extra > 128 && extra <= 153) hit.friction *= pow(10, -18 * take_unit(b));
    if (extra > 225) hit.series_order = 8 + (int)take_below(b, 25);
    if (extra < 4) { /* any of a body's numbers may be anything */
        double *p = (double *)&hit.body[extra & 1];
        p[take_below(b, sizeof hit.body[0] / sizeof *p)] = take_wild(b);
    }
    if (getenv("FUZZ_QUICK")) hit.solver = IMPACT_SOLVER_AUTO; /* a campaign: a hundred times as many without CVODE */
    if (!impact_has(IMPACT_PART_CVODE) || span > 8 || getenv("FUZZ_QUICK"))
        return; /* what only CVODE can: it is slow */
    if (extra == 4) hit.friction_law = law, hit.friction_context = law_numbers;
    if (extra == 5) hit.tangential_compliance = take_positive(b, 2), hit.law = IMPACT_STRONGE;
}

/* A static body that moves may do work. */
static bool is_pushed(void)
{
    bool pushed = false;
    for (int i = 0; i < 2; i++) {
        const impact_collider *c = &hit.body[i];
        pushed |= isinf(c->mass) && qvec3_norm(c->velocity) + qvec3_norm(c->omega) > 0;
    }
    return pushed;
}

/* The identities of an impact, which share no formula with the solvers; today's limit of an answer that may be trusted.
 */
static void hold_receipt(const impact_outcome *o)
{
    impact_receipt receipt;
    const double worst = impact_collide_receipt(&hit, o, &receipt);
    const double most = o->solver == IMPACT_SOLVER_CVODE ? 5e7 : 1e4; /* CVODE works to 1e-12, 4500 eps */
    HOLD(worst <= most, worst, most);
}

static void hold_numbers(const impact_outcome *o)
{
    const double *v = (const double *)o;
    double zero = 0;
    for (size_t i = 0; i < 15; i++) zero += v[i] * 0; /* velocities, angular velocities, impulse */
    HOLD(zero == 0, zero, 0);
    const double works = o->work_compression + o->work_restitution + o->work_friction;
    HOLD(isfinite(works) && isfinite(o->conditioning), works, o->conditioning);
    HOLD(o->impulse_normal >= 0, o->impulse_normal, 0);
}

/* The receipt counts in the sizes of all terms; beside it, energy over energy, where the data leave no room for more.
 */
static void hold_energy(const impact_outcome *o)
{
    if (is_pushed() || o->energy_rose || hit.law == IMPACT_NEWTON) return;
    if (o->energy_after <= o->energy_before * (1 + 1e-10) + DBL_MIN) return;
    const double open = impact_collide_sensitivity(&hit), rise = o->energy_after / o->energy_before - 1;
    HOLD(!(rise > 100 * DBL_EPSILON * open), rise, 100 * DBL_EPSILON * open);
}

static void hold_swapped(const impact_outcome *o)
{
    impact_collision swapped = hit;
    impact_outcome w;
    swapped.body[0] = hit.body[1], swapped.body[1] = hit.body[0];
    swapped.normal = qvec3_neg(hit.normal);
    if (impact_collide(&swapped, &w) != IMPACT_OK) return;
    const double p = qvec3_norm(o->impulse), off = qvec3_norm(qvec3_add(o->impulse, w.impulse));
    if (off <= 1e-6 * p + DBL_MIN) return;
    const double open = impact_collide_sensitivity(&hit);
    HOLD(off <= 1e-6 * p + 1e3 * DBL_EPSILON * open * p, off / p, 1e3 * DBL_EPSILON * open);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_bytes b = {data, size};
    impact_outcome o;
    char message[200];
    take_collision(&b);
    const impact_status checked = impact_collide_check(&hit, message, sizeof message);
    const impact_status status = impact_collide(&hit, &o);
    /* what the check takes may still overflow on the way: EDOMAIN, but never EARGUMENT */
    HOLD(checked >= 0 || status == checked, status, checked);
    HOLD(checked < 0 || status != IMPACT_EARGUMENT || hit.solver != IMPACT_SOLVER_AUTO, status, checked);
    if (status != IMPACT_OK && status != IMPACT_SOFT) return 0;
    hold_numbers(&o);
    if (status == IMPACT_SOFT) return 0; /* it says so */
    hold_receipt(&o);
    hold_energy(&o);
    if (o.conditioning < 1e6) hold_swapped(&o);
    return 0;
}
