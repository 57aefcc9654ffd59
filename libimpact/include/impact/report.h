/* SPDX-License-Identifier: MIT
 *
 * report: what each method of solving a scene gets right, how sure that is, and what it costs. The scene is made anew
 * for every method and tolerance, run, and compared with a reference whose certainty other methods vouch for.
 */
#ifndef IMPACT_REPORT_H
#define IMPACT_REPORT_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is varied; the setting of a row is a tolerance, of RK4 the step in s. */
typedef enum impact_report_method {
    IMPACT_REPORT_DEFAULT,  /* the scene's defaults: methods all AUTO, at tolerances */
    IMPACT_REPORT_MOTION,   /* motion = CVODE, where the default flew or rolled in closed form */
    IMPACT_REPORT_IMPACTS,  /* impacts = CVODE, where there are some */
    IMPACT_REPORT_GAPS,     /* gaps = CCD, where they have no closed form */
    IMPACT_REPORT_TEXTBOOK, /* all three at once; its gaps never asked closer than 1e-7 */
    IMPACT_REPORT_RK4,      /* motion = RK4 */
    IMPACT_REPORT_METHODS
} impact_report_method;

/* "default", "motion = cvode", ...; NULL: none. */
IMPACT_API const char *impact_report_method_name(impact_report_method method);

/* What the errors are of: all >= 0; infinite of a run that did not reach the end. */
typedef struct impact_report_error {
    double x; /* greatest distance of places, in units of the longest way X of a body: m of its centre, and its radius
               * of gyration r times the rad it turned */
    double v; /* of velocities, and r times that of angular velocities, in units of the greatest speed V, made alike */
    double q; /* of orientations, rad */
    double t; /* of the times of events that both runs have, s */
} impact_report_error;

/* The greatest of x, v and q: what rows are ordered by, and certainty is of. */
IMPACT_INLINE double impact_report_worst(impact_report_error e)
{
    const double xv = e.x > e.v ? e.x : e.v;
    return xv > e.q ? xv : e.q;
}

typedef struct impact_report_row {
    impact_report_method method;
    double setting; /* 0: none, nothing depends on the tolerance */
    impact_report_error error;
    bool below;       /* the worst error is below the certainty: no more can be said */
    int other_events; /* pairs of bodies with other events than the reference's, but for a dying tail; and when first */
    double first_other; /* s; infinite: none */
    int dying;          /* impacts that one of the two has more of right before the pair's contact is held */
    double account;     /* residual of the energy account over the greatest energy: it sees neither gaps nor motion */
    double cpu, spread; /* s, the least of rounds, of create, run and destroy; median over least */
    int rounds;         /* timed; 0: dropped, the run did not end in its time */
    impact_usage usage;
    impact_status status; /* of the run */
    double reached;       /* s */
    char message[160];    /* where it failed */
} impact_report_row;

typedef struct impact_report_def {
    size_t struct_size;                   /* sizeof(impact_report_def): a later version may have more fields */
    double seconds;                       /* budget of CPU time; 0: 20 */
    int times;                            /* at which states are compared, equidistant; 0: 48; at most 10000 */
    int rounds;                           /* of timing; 0: 7 */
    bool left_out[IMPACT_REPORT_METHODS]; /* these are not looked at */
    const double *tolerances;             /* of all but RK4 and CCD, falling; NULL: 1e-4, 1e-5 ... 1e-14 */
    int tolerance_count;
    const double *steps; /* of RK4, s, falling; NULL: 0.1, 0.03 ... 0.0003 of a second, or of a shorter duration */
    int step_count;
    /* An oracle's states in the default's stead, or NULL: in order of time, at each time every body that moves, in the
     * definition's order. The times compared are its own, and certainty the error it states. */
    const impact_sample *oracle;
    int oracle_count;
    double oracle_error;          /* in the units of the errors */
    bool (*go_on)(void *context); /* asked now and then, or NULL; false: the report ends, IMPACT_STOPPED */
    void *context;
} impact_report_def;

/* The nearest run that moves, or strikes, by another method than the reference; setting 0: there is none. */
typedef struct impact_report_witness {
    impact_report_method method;
    double setting;
} impact_report_witness;

typedef struct impact_report_summary {
    double duration;
    int times, events, rounds;
    double X, V;      /* m, m/s */
    double reference; /* the default's tolerance; 0: it has none; NaN: the oracle */
    /* Another method of motion reached the end, or there is an oracle: */
    bool sure;
    impact_report_error certainty; /* how far the reference is from its witnesses, from the farther one */
    impact_report_witness motion_witness, impact_witness;
    impact_report_error rounding; /* measured, of all that every run shares: certainty is no less (t 0) */
    /* Error per displacement of the start: of places across gravity, in X, and of spins and gravity, by the same part
     * of them; NaN: unknown. Times 1.1e-16 it is what rounding of the data alone makes. */
    double condition;
    double horizon; /* s: until then errors are compared; the duration, unless reference and witness part */
    bool useless[IMPACT_REPORT_METHODS]; /* changes nothing here, or is not in this build */
    int dropped;                         /* settings that had no time */
    double cpu;                          /* s, of all */
} impact_report_summary;

/* Takes a row; false: no more of them. */
typedef bool impact_report_sink(const impact_report_row *row, void *context);

/* Runs the scene of the definition, whose own methods are not used, by each method; rows come method by method, each
 * from loose to tight, when all are there. how NULL: all as for zeros. message (may be NULL) says what is wrong.
 *
 * Errors are the greatest at the times k T/times; one nearer to an event of the reference than T/(1000 times) is moved
 * before it, where nothing jumps. Events are matched pair of bodies by pair, in order of time. The reference is the
 * default at 1e-15, or as near to that as it ends. A run vouches for what it does not share with it: certainty is the
 * least error of all runs that move by another method, or where impacts are solved by another one that of those,
 * whichever is larger, and no less than the rounding of what all share (where contacts are found, above all), as two
 * runs tell that start 1e-11 X to either side; supports and the equations of held contacts nobody vouches for. Past the
 * horizon, where the reference and a nearest witness part by 1e-3, nothing is compared.
 *
 * IMPACT_EARGUMENT: a number out of its range; nothing moves in the scene; a force does not repeat itself, so that two
 * runs of one setting differ. IMPACT_ESINK: the sink. IMPACT_STOPPED: the reference took more than the budget, or go_on
 * said so. IMPACT_ENOMEM; else what making or running the reference answers. (Method: work-precision diagrams, as in
 * Hairer, Norsett, Wanner 1993, II.10, and Soderlind, Wang 2006.) */
IMPACT_API impact_status impact_report(const impact_scene_def *def, const impact_report_def *how,
                                       impact_report_sink *sink, void *context, impact_report_summary *summary,
                                       char *message, unsigned long message_size);

#ifdef __cplusplus
}
#endif

#endif
