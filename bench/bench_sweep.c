/* SPDX-License-Identifier: MIT
 *
 * What a sweep costs beside its scenes: CPU time of `impact sweep` over that of a bare loop over the same scenes, both
 * on one thread in the same run, the median of several; the same ratio by instructions, which a busy machine does not
 * move, where valgrind is (nan without); and what a run of one ball takes. (A million balls until they
 * stand: ./run sweep examples/sweeps/ball_to_rest.lua -- cells=1000.)
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#define COUNTED "valgrind --tool=callgrind --callgrind-out-file=/dev/null "

enum { ROUNDS = 9, RUNS = 1000, BALLS = 20000 };

/* Both scripts: balls that bounce on a floor, in closed form; so many of them that a run takes about a millisecond. */
static const char *const scene =
    "local impact = require 'impact'\n"
    "local function scene(p)\n"
    "  local bodies = { impact.body { name = 'floor', static = true, shape = impact.plane(), restitution = p.eps } }\n"
    "  for i = 1, %d do\n"
    "    bodies[i + 1] = impact.body { name = 'ball' .. i, shape = impact.sphere(0.1), position = { i, 0, 1 },\n"
    "      omega = { 0, 50 * p.eps, 0 }, friction = 0.4, restitution = p.eps }\n"
    "  end\n"
    "  return { duration = 5, output_rate = 0, bodies = bodies }\n"
    "end\n";
static const char *const loop = "for i = 0, %d do\n"
                                "  local s = impact.scene(scene { eps = 0.3 + 0.6 * i / %d })\n"
                                "  s:run {}\n"
                                "  local z, hits = s:state('ball1').position.z, s:usage().events.impact\n"
                                "  s:close()\n"
                                "end\n";
static const char *const sweep =
    "return impact.sweep { parameters = { eps = impact.grid(0.3, 0.9, %d) }, scene = scene,\n"
    "  reduce = function(run) return { z = run.scene:state('ball1').position.z, hits = run.events.impact } end }\n";

static void write_script(const char *folder, const char *name, int balls, const char *rest, int runs)
{
    char path[300];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (!file) exit(1);
    fprintf(file, scene, balls);
    fprintf(file, rest, runs, runs); /* the second number is the loop's */
    fclose(file);
}

/* CPU seconds of a command. */
static double cost(const char *command)
{
    struct rusage before, after;
    getrusage(RUSAGE_CHILDREN, &before);
    if (system(command) != 0) exit(1);
    getrusage(RUSAGE_CHILDREN, &after);
    const struct timeval a[] = {after.ru_utime, after.ru_stime}, b[] = {before.ru_utime, before.ru_stime};
    double seconds = 0;
    for (int i = 0; i < 2; i++)
        seconds += (double)(a[i].tv_sec - b[i].tv_sec) + 1e-6 * (double)(a[i].tv_usec - b[i].tv_usec);
    return seconds;
}

/* Instructions of a command, by valgrind's count; 0 where there is no valgrind. The busiest of its processes is it. */
static double instructions(const char *command)
{
    char line[300];
    double most = 0, count;
    FILE *said = popen(command, "r");
    if (!said) return 0;
    while (fgets(line, sizeof line, said)) {
        const char *found = strstr(line, "Collected : ");
        if (found && sscanf(found, "Collected : %lf", &count) == 1 && count > most) most = count;
    }
    return pclose(said) == 0 ? most : 0;
}

/* What `more` runs cost beyond `few`: their instructions by a sweep over those by a loop; the start is in neither. */
static double instructions_over(const char *folder, int few, int more)
{
    const int runs[2] = {few, more};
    double count[2][2];
    for (int k = 0; k < 2; k++) {
        char command[2][900];
        write_script(folder, "loop.lua", 13, loop, runs[k] - 1);
        write_script(folder, "sweep.lua", 13, sweep, runs[k]);
        snprintf(command[0], sizeof command[0], "cd %s && " COUNTED RUNNER " loop.lua --quiet 2>&1", folder);
        snprintf(command[1], sizeof command[1],
                 "cd %s && rm -rf out && " COUNTED RUNNER " sweep sweep.lua --quiet 2>&1", folder);
        for (int i = 0; i < 2; i++) count[i][k] = instructions(command[i]);
        if (!(count[0][k] > 0 && count[1][k] > 0)) return NAN;
    }
    return (count[1][1] - count[1][0]) / (count[0][1] - count[0][0]);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(void)
{
    char folder[] = "/tmp/bench_sweep_XXXXXX", command[3][900];
    double ratios[ROUNDS], loops[ROUNDS];
    if (!mkdtemp(folder)) return 1;
    write_script(folder, "loop.lua", 13, loop, RUNS - 1);
    write_script(folder, "sweep.lua", 13, sweep, RUNS);
    write_script(folder, "balls.lua", 1, sweep, BALLS);
    snprintf(command[0], sizeof command[0], "cd %s && " RUNNER " loop.lua --quiet", folder);
    snprintf(command[1], sizeof command[1], "cd %s && rm -rf out && " RUNNER " sweep sweep.lua --quiet", folder);
    snprintf(command[2], sizeof command[2], "cd %s && rm -rf out && " RUNNER " sweep balls.lua --quiet", folder);
    for (int i = 0; i < ROUNDS; i++) {
        loops[i] = cost(command[0]);
        ratios[i] = cost(command[1]) / loops[i];
    }
    qsort(ratios, ROUNDS, sizeof *ratios, by_size);
    qsort(loops, ROUNDS, sizeof *loops, by_size);
    printf("case,runs,ms_a_run,sweep_over_loop,by_instructions\n");
    printf("thirteen balls,%d,%.3f,%.4f,%.4f\n", RUNS, 1e3 * loops[ROUNDS / 2] / RUNS, ratios[ROUNDS / 2],
           instructions_over(folder, 100, 300));
    printf("one ball,%d,%.3f,,\n", BALLS, 1e3 * cost(command[2]) / BALLS);
    snprintf(command[0], sizeof command[0], "rm -r %s", folder);
    return system(command[0]) == 0 ? 0 : 1;
}
