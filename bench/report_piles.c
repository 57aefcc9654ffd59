/* SPDX-License-Identifier: MIT
 *
 * report_piles: three to five boxes, cylinders and polyhedra set on each other, dropped on each other, and dropped into
 * a box (tests/kit/pile_scene.h), for two seconds each.
 *
 * report_piles [--scenes N] [--seed S] [--seconds T] [--tolerance P] [--against E]
 * CSV: a row for each way to begin, and one for all, over N scenes in all (500), scene i of its own seed S + i. rest:
 * came to rest; ended: still moved after two seconds; long: not at its end after T seconds of the processor's time (5);
 * refused: with an error, or the word that the account is off; of the ended, median and slowest: seconds, and the
 * slowest's seed; overlap: of any two bodies, looked at every twentieth of a second, m; account: what the energy
 * account is off by at the end, of its greatest term; error: the greatest that a scene tells of its places, m; parted:
 * those in which it tells that motions part. P: pile_tolerance (its default). With E every scene that was stepped is
 * done again with pile_tolerance E (1e-7): compared; in how many, up to where they part by a tenth of a body's radius,
 * it was off by more than it tells in the end, and by how many times at most; and in how many they part unsaid. What is
 * not good is told on stderr.
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "kit/pile_scene.h"
#include "measure.h"
#include "options.h"

enum { LOOKS = 40 };

typedef struct tally {
    long scenes, rest, ended, too_long, refused, slowest, parted, compared, under, unsaid;
    double overlap, account, error, most, worst, *seconds;
} tally;

/* Where the bodies were, and whether that was one motion of many, at each look. */
typedef struct way {
    int looks;
    bool parted[LOOKS];
    impact_sample at[LOOKS][PILE_BODIES];
} course;

typedef struct watch {
    clock_t begin;
    double most;
} watch;

typedef struct choice {
    double seconds, tolerance, against; /* the last two: 0, not given */
} choice;

static double spent(const watch *w) { return (double)(clock() - w->begin) / CLOCKS_PER_SEC; }

static bool goes_on(void *context, double t, double end)
{
    (void)t, (void)end;
    const watch *w = context;
    return spent(w) < w->most;
}

static bool is_good(impact_status status) { return status == IMPACT_OK || status == IMPACT_AT_REST; }

static double account_of(const impact_scene *scene)
{
    const impact_energy e = impact_scene_energy(scene);
    const double greatest = fmax(fmax(fabs(e.start), e.kinetic), fmax(fabs(e.potential), e.impact_loss));
    return fabs(e.start - e.kinetic - e.potential - e.sliding_loss - e.impact_loss) / greatest;
}

static void note(const pile_scene *pile, impact_scene *scene, course *way)
{
    way->parted[way->looks] = impact_scene_pile_parted(scene) < INFINITY;
    for (int i = 0; i < pile->def.body_count; i++) impact_scene_body(scene, i, &way->at[way->looks][i]);
    way->looks++;
}

static impact_status look_on(const pile_scene *pile, impact_scene *scene, watch *w, course *way, tally *row)
{
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = w, .progress = goes_on};
    impact_status status = IMPACT_OK;
    for (int k = 1; status == IMPACT_OK && k <= LOOKS; k++) {
        status = impact_scene_run_to(scene, pile->def.duration * k / LOOKS, &recorder);
        const clock_t looking = clock();
        row->overlap = fmax(row->overlap, pile_overlap(pile, scene));
        if (is_good(status)) note(pile, scene, way);
        w->begin += clock() - looking;
    }
    return status;
}

/* The greatest that any point of a body is off by, m; *parted: one is by a tenth of its radius. */
static double off_by(const pile_scene *pile, const course *way, int look, impact_scene *finer, bool *parted)
{
    double most = 0;
    for (int i = 0; i < pile->def.body_count; i++) {
        const impact_sample *a = &way->at[look][i];
        impact_sample b;
        if (pile->bodies[i].is_static) continue;
        impact_scene_body(finer, i, &b);
        const quat turn = quat_mul(a->orientation, quat_conj(b.orientation));
        const double radius = impact_shape_bounding_radius(&pile->bodies[i].shape),
                     by = qvec3_norm(qvec3_sub(a->position, b.position)) +
                          2 * radius * qvec3_norm((qvec3){turn.x, turn.y, turn.z});
        *parted = *parted || by > 0.1 * radius;
        most = fmax(most, by);
    }
    return most;
}

/* Up to where the scene says that motions part, or they do. */
static void compare(const pile_scene *pile, const course *way, double told, double tolerance, double seconds,
                    tally *row)
{
    impact_scene_def def = pile->def;
    impact_scene *finer;
    watch w = {.begin = clock(), .most = seconds};
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &w, .progress = goes_on};
    double off = 0;
    bool parted = false, good = true;
    def.pile_tolerance = tolerance;
    if (impact_scene_create(&def, &finer, NULL, 0) != IMPACT_OK) return;
    for (int k = 0; k < way->looks && !way->parted[k] && !parted && good; k++) {
        good = is_good(impact_scene_run_to(finer, def.duration * (k + 1) / LOOKS, &recorder));
        const double by = good ? off_by(pile, way, k, finer, &parted) : 0;
        if (good && !parted) off = fmax(off, by);
    }
    row->compared++;
    row->under += off > told;
    row->unsaid += parted && !way->parted[way->looks - 1];
    row->worst = fmax(row->worst, off / fmax(told, 1e-12));
    impact_scene_destroy(finer);
}

static void count(tally *row, impact_status status, double seconds, long seed)
{
    row->rest += status == IMPACT_AT_REST;
    row->ended += status == IMPACT_OK;
    row->too_long += status == IMPACT_STOPPED;
    row->refused += !is_good(status) && status != IMPACT_STOPPED;
    if (!is_good(status)) return;
    row->seconds[row->rest + row->ended - 1] = seconds;
    if (seconds >= row->most) row->most = seconds, row->slowest = seed;
}

static void run(long seed, int start, const choice *chosen, tally *row)
{
    pile_scene pile;
    static course way;
    way.looks = 0;
    random_pile_scene((uint64_t)seed, start, &pile);
    if (chosen->tolerance > 0) pile.def.pile_tolerance = chosen->tolerance;
    impact_scene *scene = NULL;
    char words[256];
    watch w = {.begin = clock(), .most = chosen->seconds};
    tally own = {.overlap = 0};
    impact_status status = impact_scene_create(&pile.def, &scene, words, sizeof words);
    if (status == IMPACT_OK) {
        status = look_on(&pile, scene, &w, &way, &own);
        snprintf(words, sizeof words, "%s", impact_scene_message(scene));
        own.account = account_of(scene);
        own.error = impact_scene_pile_error(scene);
    }
    const double seconds = spent(&w);
    row->parted += scene && impact_scene_pile_parted(scene) < INFINITY;
    if (chosen->against > 0 && scene && impact_scene_usage(scene).pile_steps > 0 && way.looks > 0)
        compare(&pile, &way, own.error, chosen->against, 10 * chosen->seconds, row);
    row->scenes++;
    row->overlap = fmax(row->overlap, own.overlap);
    row->account = fmax(row->account, own.account);
    row->error = fmax(row->error, own.error);
    count(row, status, seconds, seed);
    const bool clean = is_good(status) && own.overlap <= 1e-10 && own.account <= 1e-9 && seconds < 1;
    if (!clean)
        fprintf(stderr, "seed %ld: %s: %s %s (t = %.4g, %.2f s, overlap %.1e m, account %.1e)\n", seed,
                pile_start_name(start), impact_status_string(status), words, scene ? impact_scene_time(scene) : 0,
                seconds, own.overlap, own.account);
    impact_scene_destroy(scene);
    pile_scene_end(&pile);
}

static void add(const tally *row, tally *all)
{
    all->scenes += row->scenes, all->rest += row->rest, all->ended += row->ended;
    all->too_long += row->too_long, all->refused += row->refused;
    all->parted += row->parted, all->compared += row->compared, all->under += row->under, all->unsaid += row->unsaid;
    all->overlap = fmax(all->overlap, row->overlap), all->account = fmax(all->account, row->account);
    all->error = fmax(all->error, row->error), all->worst = fmax(all->worst, row->worst);
    if (row->most >= all->most) all->most = row->most, all->slowest = row->slowest;
}

static void print(const char *start, const tally *row)
{
    const int good = (int)(row->rest + row->ended);
    printf("%s,%ld,%ld,%ld,%ld,%ld,%.2g,%.2g,%ld,%.1e,%.1e,%.1e,%ld,%ld,%ld,%.2g,%ld\n", start, row->scenes, row->rest,
           row->ended, row->too_long, row->refused, good > 0 ? measure_quantile(row->seconds, good, 0.5) : 0, row->most,
           row->slowest, row->overlap, row->account, row->error, row->parted, row->compared, row->under, row->worst,
           row->unsaid);
    fflush(stdout);
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"--scenes", "--seed", "--seconds", "--tolerance", "--against", NULL};
    const long scenes = options_known(argc, argv, names) ? options_count(argc, argv, "--scenes", 500) : -1,
               seed = options_count(argc, argv, "--seed", 1);
    const choice chosen = {.seconds = options_number(argc, argv, "--seconds", 5),
                           .tolerance = options_number(argc, argv, "--tolerance", 0),
                           .against = options_number(argc, argv, "--against", 0)};
    if (scenes < PILE_STARTS || seed < 0 || !(chosen.seconds > 0)) {
        fprintf(stderr, "usage: report_piles [--scenes N] [--seed S] [--seconds T] [--tolerance P] [--against E]\n");
        return 2;
    }
    double *seconds = malloc((size_t)scenes * sizeof *seconds);
    if (!seconds) return 1;
    printf("start,scenes,rest,ended,long,refused,median,slowest,its_seed,overlap,account,error,parted,compared,under,"
           "worst,unsaid\n");
    tally all = {.seconds = seconds};
    for (int start = 0; start < PILE_STARTS; start++) {
        tally row = {.seconds = seconds + all.rest + all.ended};
        for (long i = start; i < scenes; i += PILE_STARTS) run(seed + i, start, &chosen, &row);
        add(&row, &all);
        print(pile_start_name(start), &row);
    }
    print("all", &all);
    free(seconds);
    return 0;
}
