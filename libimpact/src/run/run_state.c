/* SPDX-License-Identifier: MIT */
#include "run/run_open.h"
#include "base/definition.h"
#include "base/tolerances.h"
#include "motion/key.h"

#include <string.h>

void imp_run_row(const impact_run *run, int table, long row, double *values)
{
    const imp_run_place *place = &run->tables[table];
    const char *at = place->at + sizeof(double) * (size_t)row * (size_t)place->width;
    for (int c = 0; c < imp_run_tables[table].columns; c++) {
        values[c] = 0;
        if (place->column[c] >= 0) memcpy(&values[c], at + sizeof(double) * (size_t)place->column[c], sizeof *values);
    }
}

static qvec3 vector_at(const double *v) { return (qvec3){v[0], v[1], v[2]}; }

impact_key imp_run_key(const impact_run *run, int body, long number)
{
    double v[IMP_KEY_COLUMNS];
    imp_run_row(run, IMP_RUN_KEYS, run->bodies[body].first + number, v);
    return (impact_key){v[0],
                        body,
                        vector_at(v + 1),
                        {v[4], v[5], v[6], v[7]},
                        vector_at(v + 8),
                        vector_at(v + 11),
                        vector_at(v + 14),
                        vector_at(v + 17),
                        (impact_key_form)v[20]};
}

static double key_time(const impact_run *run, int body, long number)
{
    double t;
    const imp_run_place *place = &run->tables[IMP_RUN_KEYS];
    const size_t row = (size_t)(run->bodies[body].first + number) * (size_t)place->width;
    memcpy(&t, place->at + sizeof t * (row + (size_t)place->column[0]), sizeof t);
    return t;
}

static bool can_fly(const imp_run_body *b, const impact_key *key)
{
    impact_tumble tumble;
    const qvec3 momentum = imp_inertia(&b->flight, key->orientation, key->omega);
    return !b->def.is_static && impact_tumble_make(b->def.moments, key->orientation, momentum, &tumble) == IMPACT_OK;
}

bool imp_run_key_is_sound(const impact_run *run, int body, long number)
{
    const imp_run_body *b = &run->bodies[body];
    double v[IMP_KEY_COLUMNS];
    imp_run_row(run, IMP_RUN_KEYS, b->first + number, v);
    if (!(v[20] == IMPACT_KEY_QUINTIC || v[20] == IMPACT_KEY_STEADY || v[20] == IMPACT_KEY_FREE)) return false;
    const impact_key key = imp_run_key(run, body, number);
    if (key.form == IMPACT_KEY_QUINTIC || number + 1 == b->count) return true;
    if (key.form == IMPACT_KEY_FREE && !can_fly(b, &key)) return false;
    const impact_key end = imp_run_after(run, body, number, key_time(run, body, number + 1));
    return qvec3_isfinite(end.position) && qvec3_isfinite(end.velocity) && qvec3_isfinite(end.omega) &&
           isfinite(quat_norm(end.orientation));
}

impact_key imp_run_after(const impact_run *run, int body, long number, double t)
{
    const impact_key key = imp_run_key(run, body, number);
    if (!(t > key.t) || number + 1 == run->bodies[body].count) return key;
    if (key.form != IMPACT_KEY_QUINTIC) return imp_key_alone(&run->bodies[body].flight, &key, t);
    const impact_key keys[2] = {key, imp_run_key(run, body, number + 1)};
    return imp_key_between(keys, t);
}

/* How many of the body's keys stand before t, or (with) at it as well. */
static long keys_until(const impact_run *run, int body, double t, bool with)
{
    long low = 0, high = run->bodies[body].count;
    while (low < high) {
        const long middle = low + (high - low) / 2;
        const double at = key_time(run, body, middle);
        if (at < t || (with && at == t))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static impact_status state_at(const impact_run *run, int body, double t, bool after, impact_sample *state)
{
    if (body < 0 || body >= run->body_count || !(t >= run->begin && t <= run->end)) return IMPACT_EARGUMENT;
    const long next = keys_until(run, body, t, after);
    const impact_key key = imp_run_after(run, body, next > 0 ? next - 1 : 0, t); /* before the first as it begins */
    *state =
        (impact_sample){t, body, run->bodies[body].def.name, key.position, key.orientation, key.velocity, key.omega};
    return IMPACT_OK;
}

impact_status impact_run_state(const impact_run *run, int body, double t, impact_sample *state)
{
    return state_at(run, body, t, true, state);
}

/* Of the keys at t the first ends the motion before: the search stops in front of it, and it is that motion's next. */
impact_status impact_run_state_before(const impact_run *run, int body, double t, impact_sample *state)
{
    return state_at(run, body, t, false, state);
}

/* ---- what stands in it ---- */

const void *impact_run_contents(const impact_run *run, size_t *size)
{
    *size = run->size;
    return run->bytes;
}

const char *impact_run_name(const impact_run *run) { return run->name; }
const char *impact_run_reason(const impact_run *run) { return run->reason; }
double impact_run_begin(const impact_run *run) { return run->begin; }
double impact_run_end(const impact_run *run) { return run->end; }
qvec3 impact_run_gravity(const impact_run *run) { return run->gravity; }
double impact_run_tolerance(const impact_run *run) { return run->tolerance; }
int impact_run_body_count(const impact_run *run) { return run->body_count; }

int impact_run_find(const impact_run *run, const char *body)
{
    for (int i = 0; i < run->body_count; i++)
        if (strcmp(run->bodies[i].def.name, body) == 0) return i;
    return -1;
}

impact_status impact_run_body(const impact_run *run, int body, impact_body_def *def)
{
    const bool known = body >= 0 && body < run->body_count;
    if (!known || imp_definition_refusal(def, IMP_MOST_DEFINITION)) return IMPACT_EARGUMENT;
    imp_definition_give(&run->bodies[body].def, sizeof *def, def, def->struct_size);
    return IMPACT_OK;
}

long impact_run_key_count(const impact_run *run, int body)
{
    return body < 0 || body >= run->body_count ? 0 : run->bodies[body].count;
}

impact_status impact_run_key(const impact_run *run, int body, long number, impact_key *key)
{
    if (number < 0 || number >= impact_run_key_count(run, body)) return IMPACT_EARGUMENT;
    *key = imp_run_key(run, body, number);
    return IMPACT_OK;
}

long impact_run_event_count(const impact_run *run) { return run->tables[IMP_RUN_EVENTS].rows; }
long impact_run_held_count(const impact_run *run) { return run->tables[IMP_RUN_CONTACTS].rows; }
long impact_run_account_count(const impact_run *run) { return run->tables[IMP_RUN_ACCOUNT].rows; }

static const char *word_of(const imp_words *words, double number)
{
    return number >= 0 && number < words->count ? words->word[(int)number] : "";
}

static const char *body_name(const impact_run *run, double body)
{
    return body >= 0 ? run->bodies[(int)body].def.name : "";
}

static impact_event_kind kind_of(const char *word)
{
    for (int kind = 0; kind <= IMPACT_EVENT_REST; kind++)
        if (strcmp(word, impact_event_name((impact_event_kind)kind)) == 0) return (impact_event_kind)kind;
    return IMPACT_EVENT_REST;
}

impact_status impact_run_event(const impact_run *run, long number, impact_event *event)
{
    double v[IMP_EVENT_COLUMNS];
    if (number < 0 || number >= impact_run_event_count(run)) return IMPACT_EARGUMENT;
    imp_run_row(run, IMP_RUN_EVENTS, number, v);
    const qvec3 normal = vector_at(v + 8), impulse = vector_at(v + 11);
    const double along = qvec3_dot(impulse, normal);
    *event = (impact_event){.t = v[0],
                            .kind = kind_of(word_of(&run->kinds, v[1])),
                            .body1 = (int)v[2],
                            .body2 = (int)v[3],
                            .name1 = body_name(run, v[2]),
                            .name2 = v[4] >= 0 ? word_of(&run->forces, v[4]) : body_name(run, v[3]),
                            .point = vector_at(v + 5),
                            .normal = normal,
                            .impulse = impulse,
                            .impulse_normal = along,
                            .impulse_tangential = qvec3_norm(qvec3_axpy(-along, normal, impulse)),
                            .normal_before = v[14],
                            .normal_after = v[15],
                            .phases = word_of(&run->phases, v[16]),
                            .energy_before = v[17],
                            .energy_after = v[18]};
    return IMPACT_OK;
}

static impact_hold mode_of(const char *word)
{
    for (int mode = 0; mode <= IMPACT_HOLD_STICK; mode++)
        if (strcmp(word, impact_hold_name((impact_hold)mode)) == 0) return (impact_hold)mode;
    return IMPACT_HOLD_OPEN;
}

impact_status impact_run_held(const impact_run *run, long number, impact_held *held)
{
    double v[IMP_CONTACT_COLUMNS];
    if (number < 0 || number >= impact_run_held_count(run)) return IMPACT_EARGUMENT;
    imp_run_row(run, IMP_RUN_CONTACTS, number, v);
    *held = (impact_held){.t = v[0],
                          .body1 = (int)v[1],
                          .body2 = (int)v[2],
                          .mode = mode_of(word_of(&run->modes, v[3])),
                          .point = vector_at(v + 4),
                          .normal = vector_at(v + 7),
                          .force = vector_at(v + 10)};
    return IMPACT_OK;
}

impact_status impact_run_account(const impact_run *run, long number, double *t, impact_energy *energy)
{
    double v[IMP_ACCOUNT_COLUMNS], first[IMP_ACCOUNT_COLUMNS];
    if (number < 0 || number >= impact_run_account_count(run)) return IMPACT_EARGUMENT;
    imp_run_row(run, IMP_RUN_ACCOUNT, number, v);
    imp_run_row(run, IMP_RUN_ACCOUNT, 0, first);
    *t = v[0];
    *energy = (impact_energy){.start = first[1] + first[2],
                              .kinetic = v[1],
                              .potential = v[2],
                              .force_work = v[3],
                              .drive_work = v[4],
                              .damping_loss = v[5],
                              .sliding_loss = v[6],
                              .impact_loss = v[7]};
    return IMPACT_OK;
}
