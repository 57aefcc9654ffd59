/* SPDX-License-Identifier: MIT
 *
 * The scene core: every body has its own clock, only near pairs exist, one queue, nothing is ever taken back, and the
 * bits of a body's motion depend on its own events alone.
 *
 *   segment (motion/)  how a body moves on [t0, t1], fixed once made: closed forms, or a step of the integrator
 *   search  (motion/)  when two bodies next touch, from their two segments alone
 *   tracks             every body's segment, its fat box, and the pairs of bodies whose boxes overlap
 *   queue              one time for each body (its next contact; where it leaves its box), for each island that an
 *                      integrator moves (its segment ends), and for the samples
 *   island             bodies tied by held contacts or forces between them
 *   encounter          what happens where two bodies meet or an island's segment ends in an event
 *
 * An island makes its next step when the queue reaches the end of its last, so that every segment covers [now, t1], and
 * an event at t changes segments after t only: queue times never fall, and what a cut drops nobody has seen.
 *
 * scene_build.c makes a scene, scene_run.c goes through the queue, encounter.c answers what is due: gather.c makes one
 * island of all that meets, scene_instant.c settles it (scene_strike.c: impacts; scene_hold.c: held contacts),
 * parting.c takes it apart, following.c gives each part its next segments. Internal.
 */
#ifndef IMP_SCENE_INTERNAL_H
#define IMP_SCENE_INTERNAL_H

#include <stdint.h>

#include <impact/together.h>
#include "scene/account.h"
#include "scene/island.h"
#include "scene/rules.h"
#include "scene/tracks.h"

struct impact_scene {
    char *name;
    imp_world world; /* all bodies and forces; pairs are the tracks' and the islands' */
    imp_names names; /* of the bodies */
    imp_rules rules; /* coefficients of two bodies */
    imp_queue queue; /* slot 0: the samples; then the bodies; then the islands */
    imp_tracks tracks;
    imp_island **islands;                      /* by their numbers; NULL: a number that is free */
    int island_count, island_room, first_free; /* no number below first_free is free */
    imp_island **spares;                       /* islands without a number, to be used again */
    int spare_count, spare_room;
    int *members; /* scratch: the bodies of an encounter */
    int member_count;
    imp_pair *touching; /* scratch: its pairs, by the scene's indices */
    int touching_count, touching_room;
    int *root; /* scratch, by the island's index of a body: its component */
    imp_account account;
    imp_works works; /* of islands that are no more */
    double impact_loss;
    double greatest_energy;                    /* J: the greatest term of the account so far; */
    double impact_loss_fallen, sliding_fallen; /* by how much losses that only rise have fallen */
    impact_scene_residuals receipt;
    imp_state *states; /* of all bodies, as they were asked for last */

    double t, duration;
    bool begun;    /* it has run */
    bool failed;   /* and will run on no more */
    bool unsteady; /* some force may move, some time, what rests under it now */
    impact_law law;
    double compliance;
    impact_collide_workspace *workspace;           /* solves impacts by CVODE; absent where none is asked to be */
    impact_scene_together together;                /* never AUTO */
    impact_together_workspace *together_workspace; /* absent until it is needed */
    long encounter_count;
    impact_methods methods; /* filled in: scene_methods.h */
    imp_gaps gaps;
    double rest_height, rest_speed, pile_tolerance;
    long max_events, event_count, max_steps, steps; /* steps: slots of the queue */
    impact_piles piles;
    impact_samples samples;
    bool stepped;                 /* some island has moved by steps: */
    double pile_error;            /* m: of all steps of piles, their sum; and what the motion makes of them: */
    double made, made_before;     /* m: by how far the coarser scene is; by those before it */
    double pile_parted;           /* s: from where that is no measure any more; infinite: it is one */
    struct impact_scene *coarser; /* coarser.h */
    double coarser_due;           /* s: it is followed next */
    bool is_coarser;
    double output_rate;              /* samples per second; 0: none */
    long next_sample;                /* k of the next, at k/output_rate */
    int movable, moving;             /* bodies that are not static; not at rest */
    const impact_recorder *recorder; /* of the run under way */
    impact_status stop;              /* why it refused to go on */
    bool refused;                    /* it did not take a row of the instant at hand */
    bool one_event;                  /* the run ends with the first instant that has an event: */
    impact_event *first_event;       /* where that goes, its phases here; or NULL */
    char first_phases[128];
    struct imp_scene_keys *keys; /* while a run with keys is under way */
    double energy_start, key_tolerance;
    uint64_t print; /* of its definition */
    char message[512];
};

/* The world, in its arena, of a definition that imp_scene_check has passed. */
impact_status imp_scene_build(impact_scene *scene, const impact_scene_def *def);

/* What solves impacts by CVODE, where it is asked to. */
impact_status imp_scene_open_workspace(impact_scene *scene, char *message, unsigned long size);

/* Whether nothing moves, and nothing will: no force may yet move what rests. */
bool imp_scene_rests(const impact_scene *scene);
/* Goes on to t_end. IMPACT_OK there; IMPACT_AT_REST, or why not. */
impact_status imp_scene_go_on(impact_scene *scene, double t_end);
/* Every body's state at t, in scene->states. */
impact_status imp_scene_look(impact_scene *scene, double t);
/* The same as the steps of piles leave it, overlaps between them and all. */
impact_status imp_scene_look_between(impact_scene *scene, double t);
/* By another look at what is on its own, and the one or the other at piles, into other room for all bodies' states. */
impact_status imp_scene_look_by(impact_scene *scene, double t, imp_segment_look *at, bool parted, imp_state *states);
/* The points that the steps of a pile hold, where its bodies were looked at at t; none of another island. Rows go to
 * the first `room` places; how many there are. */
int imp_island_held_by_steps(const imp_island *island, double t, impact_held *held, int room);
/* The account with the bodies in these states. */
impact_energy imp_scene_energy_of(const impact_scene *scene, const imp_state *states);
/* Kinetic + potential of all bodies but the island's at t, J. */
double imp_scene_energy_beside(impact_scene *scene, const imp_island *island, double t);

/* Counts a step, and tells the recorder how far the run is; false: it is to stop, for scene->stop. */
bool imp_scene_told(impact_scene *scene);
/* The same without a step. */
bool imp_scene_may_go_on(impact_scene *scene);
/* Whether all of the row's numbers are finite, as every row is that is handed on; else the message says whose are not.
 */
bool imp_scene_good_row(impact_scene *scene, const impact_sample *sample);

/* Works since the start, of all that moves, at the scene's time. */
imp_works imp_scene_works(const impact_scene *scene);
/* What damping has taken of a body alone since its segment began, J. */
double imp_scene_damped(const impact_scene *scene, int body, double t);

static inline int imp_scene_island_slot(const impact_scene *scene, int number)
{
    return 1 + scene->world.body_count + number;
}

/* At the island's time: all impacts there are, in the order of the pairs, then which contacts are held, in which mode.
 */
impact_status imp_scene_settle(imp_island *island);
/* The impacts of an island that goes by steps, whose pairs stay as they are; of more points than IMP_PILE_DENSE the
 * steps find them, by Newton's restitution. */
impact_status imp_scene_strike_steps(imp_island *island);
/* At the island's time: what the end of a segment stands for. */
impact_status imp_scene_handle(imp_island *island, imp_end end);

/* Kinetic + potential of the island, J. */
double imp_scene_total_energy(const imp_island *island);
impact_sample imp_scene_sample(const imp_body *body, double t, const imp_state *state);

#endif
