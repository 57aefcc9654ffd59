/* SPDX-License-Identifier: MIT
 *
 * bench_together: error against run time of encounters (docs/together.md). CSV: the case; contacts; who; work (steps,
 * linear systems, sweeps); the largest error of a velocity; CPU time, us.
 *
 * Lines of equal balls that touch, the first of which comes, elastic, linear springs or Hertz's. "springs" beside the
 * scheme of first order in the impulse (Liu, Zhao & Brogliato 2008): of the contact with most energy E the step dP, of
 * the others dP (E_i/E)^(eta/(eta + 1)), dE_i = -u_i dP_i; and beside Bullet's sequential impulses, whose answer is no
 * limit of springs (nor is MuJoCo's: peers_together.py). Errors are to the plain integration in 80 bits of
 * tests/kit/springs_oracle.h. Then random encounters with friction: medians; the error that of the receipt.
 */
#include <stdio.h>
#include <string.h>
#include "kit/encounter_random.h"
#include "kit/springs_oracle.h"
#include "measure.h"
#include "peers_together.h"

enum { MOST = 11, REPEATS = 50, RANDOM = 60 };

static random_encounter line_of(int n)
{
    random_encounter e = {.body_count = n, .meeting_count = n - 1};
    for (int i = 0; i < n; i++)
        e.bodies[i] = (impact_collider){
            .mass = 1, .moments = {0.4, 0.4, 0.4}, .orientation = {1, 0, 0, 0}, .velocity = {i == 0, 0, 0}};
    for (int i = 0; i + 1 < n; i++)
        e.meetings[i] = (impact_meeting){.body1 = i,
                                         .body2 = i + 1,
                                         .normal = {-1, 0, 0},
                                         .offset1 = {1, 0, 0},
                                         .offset2 = {-1, 0, 0},
                                         .restitution = 1,
                                         .stiffness = 1};
    return e;
}

static double error_of(const double *speed, const double *wanted, int n)
{
    double error = 0;
    for (int i = 0; i < n; i++) error = fmax(error, fabs(speed[i] - wanted[i]));
    return error;
}

static void print(const char *name, int contacts, const char *who, double work, double error, double seconds)
{
    printf("%s,%d,%s,%.0f,%.2g,%.4g\n", name, contacts, who, work, error, 1e6 * seconds);
    fflush(stdout);
}

/* ---- the scheme of first order ---- */

/* Until nothing is compressed and nothing approaches; the steps taken. */
static long first_order(int n, double exponent, double step, double *v)
{
    double energy[MOST] = {0};
    const double power = exponent / (exponent + 1);
    long steps = 0;
    for (int i = 0; i < n; i++) v[i] = i == 0;
    for (; steps < 100000000; steps++) {
        int first = -1;
        for (int i = 0; i + 1 < n; i++)
            if (energy[i] > 0 && (first < 0 || energy[i] > energy[first])) first = i;
        if (first < 0) /* none is compressed: the one that approaches fastest is */
            for (int i = 0; i + 1 < n; i++)
                if (v[i] - v[i + 1] > 1e-9 && (first < 0 || v[i] - v[i + 1] > v[first] - v[first + 1])) first = i;
        if (first < 0) break;
        double push[MOST];
        for (int i = 0; i + 1 < n; i++)
            push[i] = i == first ? step : energy[i] > 0 ? step * pow(energy[i] / energy[first], power) : 0;
        for (int i = 0; i + 1 < n; i++) {
            energy[i] = fmax(0, energy[i] + (v[i] - v[i + 1]) * push[i]);
            if (energy[i] == 0 && push[i] == 0 && v[i] - v[i + 1] > 0) energy[i] = (v[i] - v[i + 1]) * step * step;
        }
        for (int i = 0; i + 1 < n; i++) v[i] -= push[i], v[i + 1] += push[i];
    }
    return steps;
}

/* ---- lines ---- */

static void time_springs(const char *name, const random_encounter *e, double exponent, const double *wanted,
                         impact_together_workspace *workspace)
{
    impact_encounter encounter = encounter_of(e, IMPACT_TOGETHER_SPRINGS);
    encounter.exponent = exponent;
    encounter.workspace = workspace;
    qvec3 v[ENCOUNTER_BODIES];
    double speed[ENCOUNTER_BODIES], least = INFINITY;
    impact_together_outcome o = {.velocity = v};
    for (int k = 0; k < measure_count(REPEATS); k++) {
        const double begun = measure_clock();
        if (impact_collide_together(&encounter, &o) != IMPACT_OK) return;
        least = fmin(least, measure_since(begun));
    }
    for (int i = 0; i < e->body_count; i++) speed[i] = v[i].x;
    print(name, e->meeting_count, "springs", (double)o.steps, error_of(speed, wanted, e->body_count), least);
}

static void time_line(int n, double exponent, impact_together_workspace *workspace)
{
    static oracle o;
    const random_encounter e = line_of(n);
    const impact_encounter encounter = encounter_of(&e, IMPACT_TOGETHER_SPRINGS);
    const char *name = exponent == 1 ? "line linear" : "line Hertz";
    double wanted[MOST], speed[MOST], seconds;
    if (!oracle_run(&o, &encounter, exponent, true)) return;
    for (int i = 0; i < n; i++) wanted[i] = (double)o.y[6 * i];
    time_springs(name, &e, exponent, wanted, workspace);
    for (double step = 1e-2; step > 5e-6; step /= 10) {
        const double begun = measure_clock();
        const long steps = first_order(n, exponent, step, speed);
        seconds = measure_since(begun);
        print(name, n - 1, "first order in the impulse", (double)steps, error_of(speed, wanted, n), seconds);
    }
    const int sweeps[] = {10, 1000};
    for (int k = 0; k < 2; k++)
        if (bullet_line(n, sweeps[k], speed, &seconds))
            print(name, n - 1, "Bullet", sweeps[k], error_of(speed, wanted, n), seconds);
        else if (k == 0)
            fprintf(stderr, "bench_together: Bullet is not installed and is skipped\n");
}

/* ---- random encounters ---- */

static void time_random(int contacts, double friction, double exponent, impact_together_law law,
                        impact_together_workspace *workspace)
{
    const encounter_ranges ranges = {contacts, contacts, friction, 0.3, 10, 10};
    random_stream random = {(uint64_t)contacts};
    double time[RANDOM], steps[RANDOM], worst = 0;
    int count = 0;
    const int runs = measure_count(contacts > 12 ? RANDOM / 3 : RANDOM);
    for (int k = 0; k < runs; k++) {
        const random_encounter e = encounter_draw(&random, &ranges);
        impact_encounter encounter = encounter_of(&e, law);
        encounter.exponent = exponent;
        encounter.workspace = workspace;
        impact_together_outcome o = {.velocity = NULL};
        double least = INFINITY;
        for (int repeat = 0; repeat < 5; repeat++) {
            const double begun = measure_clock();
            if (impact_collide_together(&encounter, &o) != IMPACT_OK) break;
            least = fmin(least, measure_since(begun));
        }
        if (!isfinite(least)) continue;
        time[count] = least, steps[count++] = (double)o.steps;
        worst = fmax(worst, o.residual);
    }
    char name[64];
    snprintf(name, sizeof name, "random mu %g exponent %g", friction, exponent);
    print(name, contacts, impact_together_law_name(law), measure_quantile(steps, count, 0.5), worst,
          measure_quantile(time, count, 0.5));
}

int main(void)
{
    impact_together_workspace *workspace;
    if (impact_together_workspace_create(NULL, &workspace) != IMPACT_OK) return 1;
    printf("case,contacts,who,work,error,us\n");
    for (int k = 0; k < 2; k++) {
        time_line(3, k == 0 ? 1 : 1.5, workspace);
        time_line(MOST, k == 0 ? 1 : 1.5, workspace);
    }
    const int contacts[] = {3, 10, 30, 100};
    for (int k = 0; k < 4; k++) {
        time_random(contacts[k], 0, 1, IMPACT_TOGETHER_SPRINGS, workspace);
        if (contacts[k] > 30) continue;
        time_random(contacts[k], 1, 1, IMPACT_TOGETHER_SPRINGS, workspace);
        time_random(contacts[k], 1, 1.5, IMPACT_TOGETHER_SPRINGS, workspace);
        time_random(contacts[k], 1, 0, IMPACT_TOGETHER_MOREAU, workspace);
    }
    impact_together_workspace_destroy(workspace);
    return 0;
}
