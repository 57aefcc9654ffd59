/* SPDX-License-Identifier: MIT
 *
 * report_scenes: random scenes (tests/kit/random_scene.h), each to its end: does it end, and does it say what it does
 * not know? CSV, a line for each way to end: scenes that ended so, the longest of them in seconds of the processor's
 * time and its seed, the worst residuals of those that are good; and of these how many stretches between events were
 * done again, from the state just behind the first event, by the integrator that the run would not take, at a tenth of
 * the tolerance, and how many ended elsewhere: by more than 1e4 tolerances, no less than of 1e-11, of the body's size
 * and way. Chaos does not add up so. begun: of these, those that part from there alone, and not from a tenth of the
 * stretch on: where slip begins among several contacts Coulomb's law may let them go on in more than one way, and the
 * state alone does not tell from which it came. Bodies that go by a pile's steps are left out: their error is measured,
 * and told. What is not good, parts, or takes over three seconds, is told on stderr. --scenes N, --seed S (the first),
 * --steps M (max_steps, 50000: what has not ended after some eight seconds says so).
 */
#include <string.h>
#include <time.h>
#include "../tests/kit/random_scene.h"
#include "options.h"
#include "scene/scene_internal.h"

enum { STATUSES = 64, STRETCHES = 1000, SLOW = 3 };

typedef struct tally {
    const char *words;
    long scenes, stretches, parted, begun;
    double longest;
    unsigned long seed;
    double gap, contact, energy, fallen;
} tally;

typedef struct ending {
    impact_status status;
    double seconds;
    double event[STRETCHES]; /* times, each once */
    int events;
    impact_scene_residuals residuals;
    char message[512];
} ending;

static bool note_event(void *context, const impact_event *event)
{
    ending *e = context;
    if (e->events < STRETCHES && (e->events == 0 || event->t > e->event[e->events - 1]))
        e->event[e->events++] = event->t;
    return true;
}

/* A definition that is refused ends so too. */
static void run(const impact_scene_def *def, ending *e)
{
    impact_scene *scene;
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = e, .event = note_event};
    memset(e, 0, sizeof *e);
    e->status = impact_scene_create(def, &scene, e->message, sizeof e->message);
    if (!scene) return;
    const clock_t begin = clock();
    e->status = impact_scene_run(scene, &recorder);
    e->seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
    impact_scene_receipt(scene, &e->residuals);
    snprintf(e->message, sizeof e->message, "%s", impact_scene_message(scene));
    impact_scene_destroy(scene);
}

static bool is_good(impact_status status) { return status == IMPACT_OK || status == IMPACT_AT_REST; }

static bool runs_to(impact_scene *scene, double t) { return is_good(impact_scene_run_to(scene, t, NULL)); }

/* Out of each other's way: a body that is set beside one that is still elsewhere may strike it. */
static bool set_apart(impact_scene *scene, int bodies)
{
    for (int i = 1; i < bodies; i++) {
        const impact_sample away = {.position = {0, 0, 1000.0 * i}, .orientation = {1, 0, 0, 0}};
        if (impact_scene_set_state(scene, i, &away) < 0) return false;
    }
    return true;
}

/* The other goes on from where the first is. */
static bool take_over(impact_scene *first, impact_scene *other, double t, int bodies)
{
    impact_sample state;
    if (!runs_to(first, t) || !runs_to(other, t) || !set_apart(other, bodies)) return false;
    for (int i = 1; i < bodies; i++)
        if (impact_scene_body(first, i, &state) != IMPACT_OK || impact_scene_set_state(other, i, &state) < 0)
            return false;
    return true;
}

/* Whether a body, as the scene numbers it, goes by a pile's steps now. */
static bool goes_by_steps(const impact_scene *scene, int body)
{
    const int island = scene->tracks.tracks[body].island;
    return island >= 0 && scene->islands[island]->stepped;
}

/* A body's state, and whether steps have brought it there. */
typedef struct place {
    impact_sample state;
    bool stepped;
} place;

static void look(const impact_scene *scene, int bodies, place *places)
{
    for (int i = 1; i < bodies; i++) {
        impact_scene_body(scene, i, &places[i].state);
        places[i].stepped = goes_by_steps(scene, i);
    }
}

/* The farthest any body is from where the other has it, over its size and its way since `from`. */
static double apart(const place *one, const place *two, const random_scene *s, const place *from)
{
    double worst = 0;
    for (int i = 1; i < s->def.body_count; i++) {
        if (from[i].stepped || one[i].stepped) continue;
        const qvec3 at = one[i].state.position;
        const double way = qvec3_norm(qvec3_sub(at, from[i].state.position)),
                     size = impact_shape_bounding_radius(&s->bodies[i].shape);
        worst = fmax(worst, qvec3_norm(qvec3_sub(at, two[i].state.position)) / (size + way));
    }
    return worst;
}

/* Between two events: the other in the first's state at this part of the way, both compared at the end; -1: it was not
 * to be done. */
static double redo(impact_scene *first, impact_scene *other, const random_scene *s, double t0, double t1, double part)
{
    place from[1 + RANDOM_SCENE_BODIES], one[1 + RANDOM_SCENE_BODIES], two[1 + RANDOM_SCENE_BODIES];
    if (!take_over(first, other, t0 + part * (t1 - t0), s->def.body_count)) return -1;
    look(first, s->def.body_count, from);
    const double end = t0 + 0.999 * (t1 - t0);
    const long steps = impact_scene_usage(first).pile_steps;
    if (!runs_to(first, end) || !runs_to(other, end)) return -1;
    if (impact_scene_usage(first).pile_steps > steps) return 0; /* begun, and maybe ended, on the way */
    look(first, s->def.body_count, one);
    look(other, s->def.body_count, two);
    return apart(one, two, s, from);
}

/* Whether the stretch is the same from a tenth of it on. */
static bool is_same_later(const random_scene *s, const impact_scene_def *def, double t0, double t1, double allowed)
{
    impact_scene *first, *other;
    impact_scene_create(&s->def, &first, NULL, 0);
    impact_scene_create(def, &other, NULL, 0);
    const double by = first && other ? redo(first, other, s, t0, t1, 0.1) : -1;
    impact_scene_destroy(first);
    impact_scene_destroy(other);
    return by >= 0 && by <= allowed;
}

/* Stretches too short to move in, and those of a dying tail of bounces, are left out. */
static void compare(unsigned long seed, const random_scene *s, const ending *e, tally *t)
{
    impact_scene_def def = s->def;
    impact_scene *first, *other;
    def.methods.motion = IMPACT_MOTION_OTHER;
    def.tolerance = fmax(def.tolerance / 10, 1e-15);
    def.max_steps *= 4; /* of a tenth of the tolerance */
    impact_scene_create(&s->def, &first, NULL, 0);
    impact_scene_create(&def, &other, NULL, 0);
    const double shortest = 1e-4 * def.duration, allowed = 1e4 * fmax(s->def.tolerance, 1e-11);
    bool parted = false;
    for (int k = 0; first && other && k <= e->events; k++) {
        const double t0 = k > 0 ? e->event[k - 1] : 0, t1 = k < e->events ? e->event[k] : def.duration;
        if (t1 - t0 < shortest) continue;
        const double by = redo(first, other, s, t0, t1, 0.001);
        if (by < 0) break;
        t->stretches++;
        if (by <= allowed) continue;
        t->parted++;
        t->begun += is_same_later(s, &def, t0, t1, allowed);
        if (!parted)
            fprintf(stderr, "seed %lu: from t = %.9g to %.9g %.2g from the same motion by another method\n", seed, t0,
                    t1, by);
        parted = true;
    }
    impact_scene_destroy(first);
    impact_scene_destroy(other);
}

static void count(unsigned long seed, long steps, tally *tallies)
{
    random_scene s;
    static ending e;
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
    if (is_good(e.status) && e.seconds < SLOW) compare(seed, &s, &e, t);
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"--scenes", "--seed", "--steps", NULL};
    const long scenes = options_count(argc, argv, "--scenes", 1000), seed = options_count(argc, argv, "--seed", 1),
               steps = options_count(argc, argv, "--steps", 50000);
    if (!options_known(argc, argv, names) || scenes < 0 || seed < 0 || steps < 1) {
        fprintf(stderr, "usage: report_scenes [--scenes N] [--seed S] [--steps M]\n");
        return 2;
    }
    static tally tallies[STATUSES];
    for (long k = 0; k < scenes; k++) count((unsigned long)(seed + k), steps, tallies);
    printf("status,ended,scenes,longest_s,its_seed,gap,contact,energy,loss_fallen_J,stretches,parted,begun\n");
    for (int i = 0; i < STATUSES; i++)
        if (tallies[i].scenes > 0)
            printf("%d,%s,%ld,%.2f,%lu,%.1e,%.1e,%.1e,%.1e,%ld,%ld,%ld\n", i - STATUSES / 2, tallies[i].words,
                   tallies[i].scenes, tallies[i].longest, tallies[i].seed, tallies[i].gap, tallies[i].contact,
                   tallies[i].energy, tallies[i].fallen, tallies[i].stretches, tallies[i].parted, tallies[i].begun);
    return 0;
}
