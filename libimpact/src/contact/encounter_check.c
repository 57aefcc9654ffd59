/* SPDX-License-Identifier: MIT
 *
 * What impact_collide_together takes, and in which words it refuses the rest; names.
 */
#include "contact/encounter.h"

#include <stdarg.h>
#include <stdio.h>
#include "collide/collide_check.h"

const char *impact_together_law_name(impact_together_law law)
{
    switch (law) {
    case IMPACT_TOGETHER_SPRINGS: return "springs";
    case IMPACT_TOGETHER_MOREAU: return "moreau";
    case IMPACT_TOGETHER_SEQUENCE: return "sequence";
    }
    return "unknown";
}

const char *impact_together_solver_name(impact_together_solver solver)
{
    switch (solver) {
    case IMPACT_TOGETHER_NONE: return "none";
    case IMPACT_TOGETHER_ALONE: return "alone";
    case IMPACT_TOGETHER_SERIES: return "series";
    case IMPACT_TOGETHER_CONE: return "cone";
    case IMPACT_TOGETHER_SWEEPS: return "sweeps";
    }
    return "unknown";
}

typedef struct complaint {
    char *message;
    size_t size;
} complaint;

static impact_status refuse(const complaint *to, impact_status status, const char *format, ...)
{
    if (to->size > 0) {
        va_list values;
        va_start(values, format);
        vsnprintf(to->message, to->size, format, values);
        va_end(values);
    }
    return status;
}

static impact_status check_whole(const impact_encounter *e, const complaint *to)
{
    if (e->body_count < 1 || !e->bodies)
        return refuse(to, IMPACT_EARGUMENT, "there are no bodies: body_count is %d", e->body_count);
    if (e->meeting_count < 1 || !e->meetings)
        return refuse(to, IMPACT_EARGUMENT, "there are no contacts: meeting_count is %d", e->meeting_count);
    if ((unsigned)e->law > IMPACT_TOGETHER_SEQUENCE)
        return refuse(to, IMPACT_EARGUMENT, "law is %d, must be springs, moreau or sequence", (int)e->law);
    if ((unsigned)e->restitution > IMPACT_STRONGE)
        return refuse(to, IMPACT_EARGUMENT, "restitution is %d, must be Poisson's, Newton's or Stronge's",
                      (int)e->restitution);
    if (isnan(e->exponent)) return refuse(to, IMPACT_EDOMAIN, "exponent is NaN");
    if (e->exponent != 0 && !(e->exponent >= 1 && e->exponent <= 3))
        return refuse(to, IMPACT_EARGUMENT, "exponent is %g, must be in [1, 3], or 0 for 3/2", e->exponent);
    return IMPACT_OK;
}

static impact_status check_bodies(const impact_encounter *e, int i, const complaint *to)
{
    const impact_meeting *m = &e->meetings[i];
    const int pair[2] = {m->body1, m->body2};
    for (int k = 0; k < 2; k++)
        if (pair[k] < 0 || pair[k] >= e->body_count)
            return refuse(to, IMPACT_EARGUMENT, "contact %d: body%d is %d, and there are %d bodies, from 0", i, k + 1,
                          pair[k], e->body_count);
    if (m->body1 == m->body2) return refuse(to, IMPACT_EARGUMENT, "contact %d: both sides are body %d", i, m->body1);
    return IMPACT_OK;
}

impact_collision imp_encounter_collision(const impact_encounter *e, int meeting, const qvec3 *velocity,
                                         const qvec3 *omega)
{
    const impact_meeting *m = &e->meetings[meeting];
    const int pair[2] = {m->body1, m->body2};
    impact_collision c = {.normal = m->normal,
                          .friction = m->friction,
                          .restitution = m->restitution,
                          .pressed = m->pressed && e->law != IMPACT_TOGETHER_SEQUENCE};
    for (int k = 0; k < 2; k++) {
        c.body[k] = e->bodies[pair[k]];
        c.body[k].offset = k == 0 ? m->offset1 : m->offset2;
        if (velocity) c.body[k].velocity = velocity[pair[k]];
        if (omega) c.body[k].omega = omega[pair[k]];
    }
    const bool poisson = e->law == IMPACT_TOGETHER_MOREAU && e->restitution != IMPACT_NEWTON;
    c.law = e->law == IMPACT_TOGETHER_SPRINGS ? IMPACT_STRONGE : poisson ? IMPACT_POISSON : e->restitution;
    return c;
}

static impact_status check_meeting(const impact_encounter *e, int i, const complaint *to)
{
    impact_status status = check_bodies(e, i, to);
    if (status != IMPACT_OK) return status;
    const impact_meeting *m = &e->meetings[i];
    const impact_collision c = imp_encounter_collision(e, i, NULL, NULL);
    char words[200];
    if (!imp_collide_is_plain(&c)) status = impact_collide_check(&c, words, sizeof words);
    if (status != IMPACT_OK)
        return refuse(to, status, "contact %d, of body %d as 1 and body %d as 2: %s", i, m->body1, m->body2, words);
    if (e->law == IMPACT_TOGETHER_SPRINGS && isnan(m->stiffness))
        return refuse(to, IMPACT_EDOMAIN, "contact %d: stiffness is NaN", i);
    if (e->law == IMPACT_TOGETHER_SPRINGS && !(m->stiffness > 0 && isfinite(m->stiffness)))
        return refuse(to, IMPACT_EARGUMENT, "contact %d: stiffness is %g, must be > 0 and finite", i, m->stiffness);
    const int same = imp_encounter_same(e, i);
    const impact_meeting *first = &e->meetings[same];
    if (first->friction != m->friction || first->restitution != m->restitution || first->stiffness != m->stiffness)
        return refuse(to, IMPACT_EARGUMENT,
                      "contact %d is contact %d again, with another friction, restitution or stiffness", i, same);
    if (first->pressed != m->pressed)
        return refuse(to, IMPACT_EARGUMENT, "contact %d is contact %d again, pressed the one and not the other", i,
                      same);
    return IMPACT_OK;
}

impact_status impact_collide_together_check(const impact_encounter *encounter, char *message, size_t size)
{
    const complaint to = {message, size};
    if (size > 0) message[0] = '\0';
    impact_status status = check_whole(encounter, &to);
    for (int i = 0; i < encounter->meeting_count && status == IMPACT_OK; i++) status = check_meeting(encounter, i, &to);
    return status;
}
