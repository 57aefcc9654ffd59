/* SPDX-License-Identifier: MIT
 *
 * report_cones: Coulomb's law at many contacts at once (docs/cone.md), solved and proved.
 *
 * report_cones [--siconos] [FILE ...]
 * A file holds one problem, u = W r + q (report_cones_files.h says in which forms). Printed of each, and written to
 * cones_FILE.csv in the directory $OUT (out/report by ./run): the reactions and velocities of each contact, and above
 * them what was found, with three numbers over the contacts in long double: how far r is out of its cone and u_n under
 * zero, over the largest r and q, and |û . r| over both. Without a file: problems made from a known answer. CSV:
 * contacts; bodies they are among; the largest friction; problems; solved, told as inexact, told as unsettled; the
 * worst residual of the solved; the part of them that came back with the velocities they were made from (friction may
 * leave others); linear systems, median and most.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "contact/cone.h"
#include "kit/cone_cases.h"
#include "measure.h"
#include "report_cones_files.h"

/* ---- an answer ---- */

typedef struct words {
    double outside, approach, power;
} words;

static words measure_law(const cone_case *c)
{
    const int n = 3 * c->count;
    double most = 0, size = 0;
    long double outside = 0, approach = 0, power = 0;
    for (int i = 0; i < n; i++) most = fmax(most, fabs(c->r[i])), size = fmax(size, fabs(c->q[i]));
    for (int k = 0; k < c->count; k++) {
        long double u[3];
        for (int i = 0; i < 3; i++) {
            u[i] = c->q[3 * k + i];
            for (int j = 0; j < n; j++)
                u[i] += (long double)c->w[(size_t)(3 * k + i) * (size_t)n + (size_t)j] * c->r[j];
        }
        const double *r = &c->r[3 * k], friction = c->friction[k];
        const long double slip = friction > 0 ? hypotl(u[1], u[2]) : 0;
        outside = fmaxl(outside, fmaxl(-r[0], hypotl(r[1], r[2]) - friction * (long double)r[0]));
        approach = fmaxl(approach, -u[0]);
        power = fmaxl(power, fabsl((u[0] + friction * slip) * r[0] + (friction > 0 ? u[1] * r[1] + u[2] * r[2] : 0)));
    }
    if (!(most > 0)) most = 1;
    if (!(size > 0)) size = 1;
    return (words){(double)(outside / most), (double)(approach / size), (double)(power / most / size)};
}

static const char *mode_name(imp_cone_mode mode)
{
    return mode == IMP_CONE_OPEN ? "open" : mode == IMP_CONE_STICKS ? "sticks" : "slides";
}

static void write_answer(FILE *to, const char *name, const cone_case *c, const imp_cone_outcome *o,
                         const imp_cone_mode *modes, double seconds)
{
    const words w = measure_law(c);
    fprintf(to, "# %s: %d contacts, %s, residual %.3g, %d linear systems, %.3g ms\n", name, c->count,
            imp_cone_status_name(o->status), o->residual, o->factorings, 1e3 * seconds);
    if (o->status == IMP_CONE_NO_SOLUTION)
        fprintf(to, "# r is a direction: no reactions under %.3g solve it\n", o->least_reactions);
    else
        fprintf(to, "# outside the cone %.3g, approach %.3g, power %.3g%s\n", w.outside, w.approach, w.power,
                o->chosen ? "; reactions are not unique" : "");
    fprintf(to, "contact,mode,r_n,r_t1,r_t2,u_n,u_t1,u_t2\n");
    for (int k = 0; k < c->count; k++) {
        const double *r = &c->r[3 * k], *u = &c->u[3 * k];
        fprintf(to, "%d,%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", k + 1, mode_name(modes[k]), r[0], r[1], r[2], u[0],
                u[1], u[2]);
    }
}

/* Where the answers of the file go: its name without directory and ending. */
static FILE *open_answer(const char *path, char *written, size_t size)
{
    const char *directory = getenv("OUT"), *base = strrchr(path, '/');
    base = base ? base + 1 : path;
    const char *dot = strrchr(base, '.');
    snprintf(written, size, "%s/cones_%.*s.csv", directory ? directory : ".", (int)(dot ? dot - base : 255), base);
    return fopen(written, "w");
}

static int solve_file(const char *path, bool siconos, imp_cone_workspace *room)
{
    cone_case c = {0};
    const char *wrong = report_cones_read(path, siconos, &c);
    imp_cone_mode *modes = wrong ? NULL : malloc((size_t)c.count * sizeof *modes);
    if (!wrong && (!modes || !imp_cone_reserve(room, c.count))) wrong = "there is no memory for it";
    if (!wrong) {
        imp_cone_problem problem = cone_case_problem(&c);
        problem.effort = IMP_CONE_WANDERS;
        const double begun = measure_clock();
        const imp_cone_outcome outcome = imp_cone_solve(&problem, room, c.r, c.u, modes);
        const double seconds = measure_clock() - begun;
        char written[1024];
        if (outcome.status == IMP_CONE_BAD) wrong = "it holds what is no finite number, or a friction under zero";
        FILE *answer = wrong ? NULL : open_answer(path, written, sizeof written);
        if (!wrong) write_answer(stdout, path, &c, &outcome, modes, seconds);
        if (answer) write_answer(answer, path, &c, &outcome, modes, seconds);
        if (answer && fclose(answer) == 0) printf("# -> %s\n", written);
        if (!wrong && !answer) wrong = "its answer could not be written";
    }
    if (wrong) fprintf(stderr, "report_cones: %s: %s\n", path, wrong);
    cone_case_free(&c);
    free(modes);
    return wrong ? 1 : 0;
}

/* ---- known answers ---- */

typedef struct family {
    int contacts, bodies, runs;
    double friction;
} family;

static void solve_family(const family *f, imp_cone_workspace *room)
{
    random_stream random = {(uint64_t)(1000 * f->contacts + f->bodies)};
    int told[IMP_CONE_BAD + 1] = {0}, same = 0;
    double worst = 0, *systems = malloc((size_t)f->runs * sizeof *systems);
    for (int k = 0; k < f->runs; k++) {
        cone_case c = cone_case_make(&random, f->contacts, f->bodies, f->friction);
        imp_cone_problem problem = cone_case_problem(&c);
        problem.effort = IMP_CONE_WANDERS;
        double *r = calloc(6 * (size_t)c.count, sizeof *r), *u = r + 3 * c.count, off = 0;
        const imp_cone_outcome o = imp_cone_solve(&problem, room, r, u, NULL);
        for (int i = 0; i < 3 * c.count; i++) off = fmax(off, fabs(u[i] - c.u[i]));
        told[o.status]++;
        if (o.status == IMP_CONE_SOLVED) worst = fmax(worst, o.residual);
        same += o.status == IMP_CONE_SOLVED && off < 1e-9;
        systems[k] = o.factorings;
        free(r);
        cone_case_free(&c);
    }
    printf("%d,%d,%g,%d,%d,%d,%d,%.2g,%.3f,%.0f,%.0f\n", f->contacts, f->bodies, f->friction, f->runs,
           told[IMP_CONE_SOLVED], told[IMP_CONE_INEXACT], told[IMP_CONE_UNSETTLED] + told[IMP_CONE_NO_SOLUTION], worst,
           (double)same / f->runs, measure_quantile(systems, f->runs, 0.5), measure_quantile(systems, f->runs, 1));
    fflush(stdout);
    free(systems);
}

static void solve_families(imp_cone_workspace *room)
{
    static const family families[] = {
        {1, 1, 20000, 1},   {1, 1, 20000, 10},  {3, 3, 10000, 1},  {3, 1, 10000, 1},   {10, 10, 3000, 0.3},
        {10, 10, 3000, 1},  {10, 3, 3000, 0.3}, {10, 3, 3000, 1},  {10, 10, 1000, 10}, {10, 3, 1000, 10},
        {30, 15, 200, 0.3}, {30, 15, 200, 1},   {30, 10, 200, 10}, {100, 50, 20, 1},   {300, 150, 2, 1},
    };
    printf("contacts,bodies,friction,problems,solved,inexact,unsettled,residual,same,systems,systems_most\n");
    for (size_t i = 0; i < sizeof families / sizeof *families; i++)
        if (imp_cone_reserve(room, families[i].contacts)) solve_family(&families[i], room);
}

int main(int argc, char **argv)
{
    imp_cone_workspace room = {.capacity = 0};
    if (imp_arena_create(NULL, &room.arena) != IMPACT_OK) return 1;
    int bad = 0;
    const bool siconos = argc > 1 && strcmp(argv[1], "--siconos") == 0;
    for (int i = 1 + siconos; i < argc; i++) bad += solve_file(argv[i], siconos, &room);
    if (argc == 1) solve_families(&room);
    imp_arena_destroy(room.arena);
    return bad > 0;
}
