/* SPDX-License-Identifier: MIT
 *
 * impact_gap on any two solids: numbers with an answer and NaN without; a unit normal; a bracket in order and as narrow
 * as is promised; witness points that lie on their surfaces and differ by gap times normal; the same with the solids
 * swapped.
 */
#include "solids.h"

static impact_solid one, two;

void fuzz_show(FILE *out)
{
    fputs("#include <impact/impact.h>\n#include <math.h>\n#include <stdio.h>\n\nint main(void)\n{\n", out);
    show_solid(out, "one", &one);
    show_solid(out, "two", &two);
    fputs("    impact_contact c, d;\n    const impact_status s = impact_gap(&one, &two, NULL, &c), t = "
          "impact_gap(&two, &one, NULL, &d);\n"
          "    printf(\"%s: %.17g in [%.17g, %.17g]\\n\", impact_status_string(s), c.gap, c.lower, c.upper);\n"
          "    printf(\"swapped, %s: %.17g in [%.17g, %.17g]\\n\", impact_status_string(t), d.gap, d.lower, "
          "d.upper);\n}\n",
          out);
}

/* How far rounding of the normal moves a point of the surface, over the size: by 1/(exponent - 1) of it. */
static double softness(const impact_shape *s)
{
    const double e[3] = {s->r, s->s, s->t};
    double least = INFINITY;
    for (int i = 0; i < 3; i++)
        if (e[i] > 1) least = fmin(least, e[i] - 1);
    return 1e-13 / least;
}

static void hold_alike(const impact_contact *c, const impact_contact *d, double scale)
{
    HOLD(fabs(c->gap - d->gap) <= 1e-13 * scale, fabs(c->gap - d->gap) / scale, 1e-13);
    const qvec3 w = qvec3_sub(qvec3_sub(qvec3_add(c->offset1, one.position), two.position), c->offset2);
    const double off = qvec3_norm(qvec3_sub(w, qvec3_scale(c->normal, c->gap)));
    const double big = scale + qvec3_norm(one.position) + qvec3_norm(two.position);
    const double room = 1e-6 + softness(&one.shape) + softness(&two.shape);
    HOLD(off <= room * big, off / big, room);
}

/* No direction separates or parts the solids by more than the gap: the support along a direction bounds it. */
static void hold_bound(fuzz_bytes *b, const impact_contact *c, double scale)
{
    if (one.shape.kind == IMPACT_PLANE || two.shape.kind == IMPACT_PLANE) return;
    for (int k = 0; k < 6; k++) {
        const qvec3 n = quat_rotate(take_quat(b), (qvec3){0, 0, 1});
        const double reach =
            impact_shape_support(&one.shape, quat_rotate_inverse(one.orientation, qvec3_neg(n)), NULL) +
            impact_shape_support(&two.shape, quat_rotate_inverse(two.orientation, n), NULL);
        const double apart = qvec3_dot(n, qvec3_sub(one.position, two.position)) - reach;
        HOLD(apart <= c->upper + 1e-13 * scale, (apart - c->upper) / scale, 1e-13);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_bytes b = {data, size};
    const double far = take_byte(&b) < 16 ? 8 : 2;
    one = take_solid(&b, far), two = take_solid(&b, far);
    impact_contact c, d;
    const impact_status s = impact_gap(&one, &two, NULL, &c), t = impact_gap(&two, &one, NULL, &d);
    HOLD((s < 0) == (t < 0), s, t);
    if (s < 0) {
        HOLD(isnan(c.gap), c.gap, 0);
        return 0;
    }
    const double scale = fmax(solid_size(&one), solid_size(&two)) + qvec3_norm(qvec3_sub(one.position, two.position));
    HOLD(isfinite(c.gap) && qvec3_isfinite(c.normal), c.gap, 0);
    HOLD(fabs(qvec3_norm(c.normal) - 1) < 1e-14, qvec3_norm(c.normal) - 1, 1e-14);
    HOLD(c.lower <= c.gap && c.gap <= c.upper, c.gap, c.lower);
    if (s == IMPACT_OK) HOLD(c.upper - c.lower <= 4.1e-14 * scale, (c.upper - c.lower) / scale, 4.1e-14);
    if (s == IMPACT_OK && t == IMPACT_OK) hold_alike(&c, &d, scale);
    hold_bound(&b, &c, scale);
    return 0;
}
