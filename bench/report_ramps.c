/* SPDX-License-Identifier: MIT
 *
 * report_ramps: boxes of exponents 4 ... 1e4 on ramps of 0 ... 45 degrees with friction 0 ... 1
 * (tests/kit/ramp_scene.h), for two seconds each.
 *
 * report_ramps [--scenes N] [--seed S] [--seconds T]
 * CSV: a row for each way to begin, over N scenes in all (1000), scene i of its own seed S + i. rest: came to rest;
 * ended: still moved after two seconds; long: not at its end after T seconds of the processor's time (5); refused: with
 * an error, or the word that the account is off; of the ended, median and slowest: seconds; closed: those without
 * turning whose pressure stays on the flat place, and the worst of their places against the closed form, over the box's
 * size and its way. What is not good is told on stderr.
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "../tests/kit/ramp_scene.h"
#include "measure.h"
#include "options.h"

typedef struct tally {
    long scenes, rest, ended, too_long, refused, closed;
    double off, *seconds;
} tally;

typedef struct watch {
    clock_t begin;
    double most;
} watch;

static double spent(const watch *w) { return (double)(clock() - w->begin) / CLOCKS_PER_SEC; }

static bool goes_on(void *context, double t, double end)
{
    (void)t, (void)end;
    const watch *w = context;
    return spent(w) < w->most;
}

static void compare(const ramp_scene *ramp, const impact_scene *scene, tally *row)
{
    impact_sample s;
    impact_scene_body(scene, 1, &s);
    const impact_body_def *box = &ramp->bodies[1];
    const double way = ramp_way(ramp, ramp->def.duration), size = impact_shape_bounding_radius(&box->shape);
    const qvec3 due = qvec3_axpy(way, ramp->down, box->position);
    row->closed++;
    row->off = fmax(row->off, qvec3_norm(qvec3_sub(s.position, due)) / (size + fabs(way)));
}

static void tell(const ramp_scene *ramp, long seed, const char *words, double t, double seconds)
{
    fprintf(stderr, "seed %ld: %s, exponent %.4g, %.3g degrees, friction %.3g: %s (t = %.4g, %.2f s)\n", seed,
            ramp_start_name(ramp->start), ramp->exponent, ramp->angle * 57.29577951308232, ramp->friction, words, t,
            seconds);
}

static void run(long seed, int start, double most, tally *row)
{
    random_stream random = {(uint64_t)seed};
    ramp_scene ramp;
    random_ramp_scene(&random, start, &ramp);
    impact_scene *scene;
    watch w = {.begin = clock(), .most = most};
    impact_status status = impact_scene_create(&ramp.def, &scene, NULL, 0);
    row->scenes++;
    if (status != IMPACT_OK) {
        row->refused++;
        tell(&ramp, seed, impact_status_string(status), 0, 0);
        return;
    }
    const impact_recorder recorder = {.struct_size = sizeof recorder, .context = &w, .progress = goes_on};
    status = impact_scene_run(scene, &recorder);
    const bool good = status == IMPACT_OK || status == IMPACT_AT_REST;
    row->seconds[row->rest + row->ended] = spent(&w);
    if (!good)
        tell(&ramp, seed, status == IMPACT_STOPPED ? "too long" : impact_scene_message(scene), impact_scene_time(scene),
             spent(&w));
    row->rest += status == IMPACT_AT_REST;
    row->ended += status == IMPACT_OK;
    row->too_long += status == IMPACT_STOPPED;
    row->refused += !good && status != IMPACT_STOPPED;
    if (good && start != RAMP_TURNED && ramp_stays_flat(&ramp)) compare(&ramp, scene, row);
    impact_scene_destroy(scene);
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"--scenes", "--seed", "--seconds", NULL};
    const long scenes = options_known(argc, argv, names) ? options_count(argc, argv, "--scenes", 1000) : -1,
               seed = options_count(argc, argv, "--seed", 1);
    const double most = options_number(argc, argv, "--seconds", 5);
    if (scenes < RAMP_STARTS || seed < 0 || !(most > 0)) {
        fprintf(stderr, "usage: report_ramps [--scenes N] [--seed S] [--seconds T]\n");
        return 2;
    }
    double *seconds = malloc((size_t)scenes * sizeof *seconds);
    if (!seconds) return 1;
    printf("start,scenes,rest,ended,long,refused,median,slowest,closed,off\n");
    for (int start = 0; start < RAMP_STARTS; start++) {
        tally row = {.seconds = seconds};
        for (long i = start; i < scenes; i += RAMP_STARTS) run(seed + i, start, most, &row);
        const int good = (int)(row.rest + row.ended);
        const double median = measure_quantile(seconds, good, 0.5);
        printf("%s,%ld,%ld,%ld,%ld,%ld,%.2g,%.2g,%ld,%.2g\n", ramp_start_name(start), row.scenes, row.rest, row.ended,
               row.too_long, row.refused, good > 0 ? median : 0, good > 0 ? seconds[good - 1] : 0, row.closed, row.off);
        fflush(stdout);
    }
    free(seconds);
    return 0;
}
