/* SPDX-License-Identifier: MIT
 *
 * report_scenes: random scenes (tests/kit/random_scene.h), each to its end: does it end, and does it say what it does
 * not know? CSV, a line for each way to end: scenes that ended so, the longest of them in seconds of the processor's
 * time and its seed, the worst residuals of those that are good, and of these (without forces) how many part from
 * the same motion by the integrator by more than 1e4 tolerances, up to twenty events: chaos does the rest.
 * What is not good, parts, or takes over three seconds, is told on stderr. --scenes N, --seed S (the first), --steps M
 * (max_steps).
 */
#include <string.h>
#include <time.h>
#include "../tests/kit/random_scene.h"
#include "options.h"

enum { STATUSES = 64, FEW_EVENTS = 20, SLOW = 3 };

typedef struct tally {
    const char *words;
    long scenes, compared, parted;
    double longest;
    unsigned long seed;
    double gap, contact, energy, fallen;
} tally;

typedef struct ending {
    impact_status status;
    double seconds;
    qvec3 place[RANDOM_SCENE_BODIES];
    long events;
    impact_scene_residuals residuals;
    char message[512];
} ending;

/* False where the definition is refused; that is an ending too. */
static bool run(const impact_scene_def *def, ending *e)
{
    impact_scene *scene;
    memset(e, 0, sizeof *e);
    e->status = impact_scene_create(def, &scene, NULL, 0);
    if (!scene) return false;
    const clock_t begin = clock();
    e->status = impact_scene_run(scene, NULL);
    e->seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
    impact_scene_receipt(scene, &e->residuals);
    snprintf(e->message, sizeof e->message, "%s", impact_scene_message(scene));
    const impact_usage usage = impact_scene_usage(scene);
    for (int kind = 0; kind <= IMPACT_EVENT_REST; kind++) e->events += usage.events[kind];
    for (int i = 1; i < def->body_count; i++) {
        impact_sample sample;
        impact_scene_body(scene, i, &sample);
        e->place[i - 1] = sample.position;
    }
    impact_scene_destroy(scene);
    return true;
}

static bool nothing(double t, int body, double mass, qvec3 x, quat q, qvec3 v, qvec3 w, qvec3 *force, qvec3 *torque,
                    void *context)
{
    (void)t, (void)body, (void)mass, (void)x, (void)q, (void)v, (void)w, (void)force, (void)torque, (void)context;
    return true;
}

static bool is_good(impact_status status) { return status == IMPACT_OK || status == IMPACT_AT_REST; }

/* The same by the integrator throughout: a force that does nothing. */
static void compare(unsigned long seed, random_scene *s, const ending *first, tally *t)
{
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_CUSTOM);
    force.function = nothing;
    force.max_step = INFINITY;
    force.steady = true;
    s->def.forces = &force;
    s->def.force_count = 1;
    ending second;
    if (!run(&s->def, &second) || !is_good(second.status)) return;
    double apart = 0;
    for (int i = 0; i < s->def.body_count - 1; i++)
        apart = fmax(apart, qvec3_norm(qvec3_sub(first->place[i], second.place[i])));
    t->compared++;
    if (apart <= 1e4 * s->def.tolerance * (1 + qvec3_norm(first->place[0]))) return;
    t->parted++;
    fprintf(stderr, "seed %lu: after %ld events %.2g m from the same motion by the integrator\n", seed, first->events,
            apart);
}

static void count(unsigned long seed, long steps, tally *tallies)
{
    random_scene s;
    ending e;
    random_scene_make(seed, &s);
    s.def.max_steps = steps;
    run(&s.def, &e);
    tally *t = &tallies[e.status + STATUSES / 2];
    t->words = impact_status_string(e.status);
    t->scenes++;
    if (e.seconds >= t->longest) t->longest = e.seconds, t->seed = seed;
    t->gap = fmax(t->gap, e.residuals.gap);
    t->contact = fmax(t->contact, e.residuals.contact);
    t->energy = fmax(t->energy, e.residuals.energy);
    t->fallen = fmax(t->fallen, e.residuals.loss_fallen);
    if (!is_good(e.status) || e.seconds > SLOW)
        fprintf(stderr, "seed %lu: %s after %.2f s: %s\n", seed, t->words, e.seconds, e.message);
    if (is_good(e.status) && s.def.force_count == 0 && e.events <= FEW_EVENTS) compare(seed, &s, &e, t);
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"--scenes", "--seed", "--steps", NULL};
    const long scenes = options_count(argc, argv, "--scenes", 1000), seed = options_count(argc, argv, "--seed", 1),
               steps = options_count(argc, argv, "--steps", 200000);
    if (!options_known(argc, argv, names) || scenes < 0 || seed < 0 || steps < 1) {
        fprintf(stderr, "usage: report_scenes [--scenes N] [--seed S] [--steps M]\n");
        return 2;
    }
    static tally tallies[STATUSES];
    for (long k = 0; k < scenes; k++) count((unsigned long)(seed + k), steps, tallies);
    printf("status,ended,scenes,longest_s,its_seed,gap,contact,energy,loss_fallen_J,compared,parted\n");
    for (int i = 0; i < STATUSES; i++)
        if (tallies[i].scenes > 0)
            printf("%d,%s,%ld,%.2f,%lu,%.1e,%.1e,%.1e,%.1e,%ld,%ld\n", i - STATUSES / 2, tallies[i].words,
                   tallies[i].scenes, tallies[i].longest, tallies[i].seed, tallies[i].gap, tallies[i].contact,
                   tallies[i].energy, tallies[i].fallen, tallies[i].compared, tallies[i].parted);
    return 0;
}
