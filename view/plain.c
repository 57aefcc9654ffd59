/* SPDX-License-Identifier: MIT */
#include "plain.h"
#include "motion/key.h"
#include "run/text.h"

typedef struct plainer {
    const impact_run *run;
    imp_text rows;
    long count;
} plainer;

static bool put_row(plainer *p, const double *row)
{
    imp_text_put(&p->rows, row, IMP_KEY_COLUMNS * sizeof *row);
    p->count++;
    return !p->rows.failed;
}

static bool put_key(void *context, const impact_key *k)
{
    double row[IMP_KEY_COLUMNS];
    imp_run_key_row(k, row);
    return put_row(context, row);
}

/* One free flight, up to the next key. */
typedef struct flight {
    const imp_body *body;
    impact_key from;
    double to;
} flight;

static double time_at(const flight *f, double s) { return s < 1 ? f->from.t + s * (f->to - f->from.t) : f->to; }

static impact_key key_at(void *context, int body, double s)
{
    (void)body;
    const flight *f = context;
    impact_key key = imp_key_alone(f->body, &f->from, time_at(f, s));
    key.form = IMPACT_KEY_QUINTIC;
    return key;
}

static imp_pose pose_at(void *context, int body, double s)
{
    const impact_key key = key_at(context, body, s);
    return (imp_pose){key.t, key.position, key.orientation};
}

static impact_key begin_of(void *context, int body) { return key_at(context, body, 0); }

static bool put_flight(plainer *p, int body, const impact_key *from, double to)
{
    long unmet = 0;
    imp_key_line line = {0};
    const impact_body_def *def = &p->run->bodies[body].def;
    const double size = impact_shape_bounding_radius(&def->shape) + qvec3_norm(def->shape_position);
    const imp_key_tolerance tolerance = {p->run->tolerance * size, p->run->tolerance};
    flight way = {&p->run->bodies[body].flight, *from, to};
    const imp_piece piece = {
        .from = from->t, .to = to, .context = &way, .at = key_at, .pose = pose_at, .begin = begin_of};
    return imp_key_line_add_piece(&line, &piece, body, tolerance, put_key, p, &unmet) &&
           imp_key_line_end(&line, put_key, p);
}

static bool put_body(plainer *p, int body, bool *changed)
{
    const imp_run_body *b = &p->run->bodies[body];
    bool good = true;
    for (long k = 0; good && k < b->count; k++) {
        const impact_key key = imp_run_key(p->run, body, k);
        const double to = k + 1 < b->count ? imp_run_key(p->run, body, k + 1).t : key.t;
        const bool flies = key.form == IMPACT_KEY_FREE && to > key.t;
        *changed |= flies;
        good = flies ? put_flight(p, body, &key, to) : put_key(p, &key);
    }
    return good;
}

impact_status imp_plain(imp_arena *arena, const impact_run *run, impact_run *plain, bool *changed)
{
    plainer p = {.run = run, .rows = {.arena = arena}};
    *plain = *run;
    *changed = false;
    plain->bodies = imp_arena_take(arena, (size_t)run->body_count, sizeof *plain->bodies);
    if (!plain->bodies) return IMPACT_ENOMEM;
    for (int b = 0; b < run->body_count; b++) {
        const long first = p.count;
        plain->bodies[b] = run->bodies[b];
        if (!put_body(&p, b, changed)) return IMPACT_ENOMEM;
        plain->bodies[b].first = first;
        plain->bodies[b].count = p.count - first;
    }
    imp_run_place *keys = &plain->tables[IMP_RUN_KEYS];
    *keys = (imp_run_place){.at = p.rows.bytes, .rows = p.count, .width = IMP_KEY_COLUMNS};
    for (int c = 0; c < IMP_KEY_COLUMNS; c++) keys->column[c] = c;
    return IMPACT_OK;
}
