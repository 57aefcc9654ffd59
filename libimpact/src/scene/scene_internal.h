/* SPDX-License-Identifier: MIT
 *
 * The scene as its own source files see it: scene_build.c makes it, scene_instant.c does what happens at one instant
 * (scene_strike.c: impacts; scene_hold.c: held contacts), scene_advance.c goes from one to the next, scene.c runs it.
 * Internal.
 */
#ifndef IMP_SCENE_INTERNAL_H
#define IMP_SCENE_INTERNAL_H

#include "motion/motion.h"

struct impact_scene {
    char *name;
    imp_world world;
    imp_motion motion;
    imp_state *states;
    imp_state *before; /* as the states were when the event at hand came */
    imp_mode *modes;   /* as the pairs' modes were then */
    double t, duration;
    impact_law law;
    double compliance;
    impact_collide_workspace *springs; /* solves impacts with compliance; absent without it */
    impact_solver solver;
    double rest_height, rest_speed;
    long max_events, event_count;
    long stalls; /* events since time last moved */
    imp_sampler sampler;
    const impact_recorder *recorder; /* of the run under way */
    impact_status stop;              /* why the recorder stopped the run */
    double energy_start, impact_loss, key_tolerance;
    double impact_loss_before, impact_loss_fallen; /* as the receipt saw it last; the sum of its falls */
    double greatest_energy;                        /* the greatest term of the account so far */
    impact_scene_residuals receipt;
    long steps, max_steps;         /* calls of imp_scene_told */
    bool begun;                    /* it has run */
    struct imp_scene_keys *keys;   /* while a run with keys is under way */
    bool beside_event;             /* the rows that go to the recorder now stand beside an event */
    struct imp_scene_crowd *crowd; /* of many bodies, that are moved in groups; NULL: all at once */
    struct imp_scene_pile *pile;   /* steps it where the exact method does not get on; NULL: never */
    char message[512];
};

/* The world, in its arena, of a definition that imp_scene_check has passed. */
impact_status imp_scene_build(impact_scene *scene, const impact_scene_def *def);

/* One stretch of motion and the event at its end. */
impact_status imp_scene_advance(impact_scene *scene, double t_end);
typedef impact_status (*imp_scene_step)(impact_scene *scene, double t_end);
/* On to the time t_end by such steps, as far as it goes: IMPACT_OK there, IMPACT_AT_REST, or why not. */
impact_status imp_scene_go_on(impact_scene *scene, double t_end, imp_scene_step step);
/* Before every stretch and after every step of an integrator: counts it, and tells the recorder how far the run is.
 * False: it is to stop. */
bool imp_scene_told(impact_scene *scene, double t);
/* Whether all of the row's numbers are finite, as every row is that is handed on; else the message says whose are not.
 */
bool imp_scene_good_row(impact_scene *scene, const impact_sample *sample);
/* Puts every body's row into the recorder; for the sampler. */
bool imp_scene_emit(void *scene, double t, const imp_state *states);

/* Kinetic + potential, J. */
double imp_scene_total_energy(const impact_scene *scene);
impact_sample imp_scene_sample(const impact_scene *scene, double t, int body, const imp_state *states);

/* At the scene's time: all impacts there are, in the order of the pairs, then which contacts are held, in
 * which mode. */
impact_status imp_scene_settle(impact_scene *scene);
/* At the scene's time: what the end of a stretch of motion stands for. */
impact_status imp_scene_handle(impact_scene *scene, imp_end end);

#endif
