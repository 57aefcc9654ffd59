/* SPDX-License-Identifier: MIT
 *
 * impact_toi on any two moving solids: a time in range; at an answer the solids touch; before it, and where none is
 * found, none of the instants looked at has them overlap.
 */
#include "solids.h"

#include <impact/toi.h>

static impact_solid one, two;
static impact_motion first, second;
static double t_max;

static void show_motion(FILE *out, const char *name, const impact_motion *m)
{
    fprintf(out, "    const impact_motion %s = {", name);
    show_vec3(out, "", m->velocity);
    show_vec3(out, ", ", m->acceleration);
    show_vec3(out, ", ", m->omega);
    fputs("};\n", out);
}

void fuzz_show(FILE *out)
{
    fputs("#include <impact/impact.h>\n#include <math.h>\n#include <stdio.h>\n\nint main(void)\n{\n", out);
    show_solid(out, "one", &one);
    show_solid(out, "two", &two);
    show_motion(out, "first", &first);
    show_motion(out, "second", &second);
    fprintf(out,
            "    double time;\n    impact_contact c;\n"
            "    const impact_status s = impact_toi(&one, &first, &two, &second, %.17g, &time, &c);\n",
            t_max);
    fputs("    printf(\"%s: t = %.17g, gap %.17g\\n\", impact_status_string(s), time, c.gap);\n}\n", out);
}

static impact_motion take_motion(fuzz_bytes *b, const impact_solid *solid)
{
    const impact_motion m = {take_vec3(b, 3), take_vec3(b, 2), take_vec3(b, 2)};
    return solid->shape.kind == IMPACT_PLANE ? (impact_motion){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}} : m;
}

/* How fast any point of the solid may go until t. */
static double top_speed(const impact_solid *s, const impact_motion *m, double t)
{
    return qvec3_norm(m->velocity) + t * qvec3_norm(m->acceleration) + solid_size(s) * qvec3_norm(m->omega);
}

/* The room a gap may be off by at t: rounding of the gap, of places, and of the time itself. */
static double allowed(double t)
{
    const impact_solid a = impact_motion_at(&one, &first, t), b = impact_motion_at(&two, &second, t);
    const double scale = solid_size(&one) + solid_size(&two) + qvec3_norm(a.position) + qvec3_norm(b.position);
    return 1e-9 * (scale + t * (top_speed(&one, &first, t) + top_speed(&two, &second, t)));
}

static double gap_at(double t)
{
    const impact_solid a = impact_motion_at(&one, &first, t), b = impact_motion_at(&two, &second, t);
    impact_contact c;
    return impact_gap(&a, &b, NULL, &c) < 0 ? INFINITY : c.upper;
}

/* Beside a plane's edges there is nothing to meet, and the gap goes on. */
static void drop_edges(impact_solid *s)
{
    if (s->shape.kind == IMPACT_PLANE) s->shape.a = s->shape.b = INFINITY;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_bytes b = {data, size};
    one = take_solid(&b, 1), two = take_solid(&b, 1);
    drop_edges(&one), drop_edges(&two);
    first = take_motion(&b, &one), second = take_motion(&b, &two);
    t_max = take_positive(&b, 2);
    double time;
    impact_contact at;
    const impact_status s = impact_toi(&one, &first, &two, &second, t_max, &time, &at);
    if (s != IMPACT_OK && s != IMPACT_NO_CONTACT && s != IMPACT_EUNSETTLED) {
        HOLD(s < 0 && isnan(time), time, s);
        return 0;
    }
    HOLD(time >= 0 && time <= t_max, time, t_max);
    if (s == IMPACT_NO_CONTACT) HOLD(time == t_max, time, t_max);
    if (s == IMPACT_OK && time > 0)
        HOLD(at.lower <= allowed(time) && at.upper >= -allowed(time), at.gap, allowed(time));
    for (int k = 0; k < 8 && time > 0; k++) {
        const double t = time * (0.999 * take_byte(&b) / 255), gap = gap_at(t);
        HOLD(gap >= -allowed(t), gap, -allowed(t));
    }
    return 0;
}
