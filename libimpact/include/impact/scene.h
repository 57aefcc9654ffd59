/* SPDX-License-Identifier: MIT
 *
 * scene: bodies, forces and material rules, and their motion through impacts, rolling and rest.
 * Definitions are plain structs; impact_scene_create copies all it needs. One scene per thread; scenes share nothing.
 */
#ifndef IMPACT_SCENE_H
#define IMPACT_SCENE_H

#include <quat/quat.h>
#include "collide.h"
#include "force.h"
#include "record.h"
#include "shape.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Definitions begin with the size of the struct that the caller was compiled with: a later version may have more fields
 * at its end. impact_default_..._def sets it; docs/embed.md. */
typedef struct impact_body_def {
    size_t struct_size;
    const char *name; /* unique in the scene, not empty */
    impact_shape shape;
    bool is_static;   /* never moves, but its surface may: see velocity; planes must be static */
    double mass;      /* kg; NaN: density times the shape's volume. Ignored for static bodies */
    double density;   /* kg/m^3; used when mass is NaN */
    qvec3 moments;    /* principal moments about the centre, kg m^2, along the body axes; NaN: of the uniform solid */
    qvec3 position;   /* of the centre of mass, m */
    quat orientation; /* body to world; normalised */
    /* Where the shape's centre and axes stand in the body's frame, which is that of its centre of mass and principal
     * moments: m, and shape to body, normalised. With anything but 0 and 1 the moments must be given. Not for planes.
     */
    qvec3 shape_position;
    quat shape_orientation;
    qvec3 velocity; /* m/s */
    qvec3 omega;    /* rad/s, world */
    /* Of a static body they are its surface's, that moves along itself, for ever: the point x by velocity + omega x (x
     * - position). Only what leaves its shape in place is allowed: along a plane, as a belt; about the normal of a
     * plane without edges, as a turntable; about an axis through the shape's centre on which the shape is round, as a
     * drum. */
    double friction;    /* >= 0; joined with the other body's by the scene's rule */
    double restitution; /* in [0, 1] */
    /* tau and rho, m, >= 0, of a pair the sum of both bodies': held by the normal force N, a contact resists turning
     * about its normal with up to tau N (together with friction: |(F/mu, M/tau)| <= N) and rolling with up to rho N;
     * in impacts the same of impulses. docs/cone.md */
    double torsional_friction, rolling_friction;
    double linear_damping,
        angular_damping; /* part of the (angular) velocity lost per second, in [0, 1): factor (1 - d)^t */
    qvec3 trail;         /* body frame, m: whose way viewers draw; no motion depends on it */
    void *user;          /* the caller's own: impact_scene_body_def gives it back, nothing else looks at it */
} impact_body_def;

/* How two bodies' coefficients make the pair's. */
typedef enum impact_pair_rule {
    IMPACT_PRODUCT,
    IMPACT_GEOMETRIC_MEAN,
    IMPACT_MINIMUM,
    IMPACT_MAXIMUM
} impact_pair_rule;

/* One pair's own coefficients, over the rule; NaN: by the rule. */
typedef struct impact_pair_def {
    size_t struct_size;
    const char *body1, *body2;
    double friction, restitution;
    double stiffness; /* of springs that answer together, any unit: only ratios count; 0 or NaN: Hertz's, of bodies of
                       * one modulus */
    double torsional_friction, rolling_friction; /* m, >= 0; NaN: the sum of the bodies' */
} impact_pair_def;

/* What answers contacts that are struck at one instant: docs/together.md. */
typedef enum impact_scene_together {
    IMPACT_SCENE_TOGETHER_AUTO, /* by the law of restitution: Poisson's and Newton's: MOREAU; Stronge's: SPRINGS; with
                                 * compliance or a solver by name: SEQUENCE */
    IMPACT_SCENE_SPRINGS,       /* with Stronge's law only */
    IMPACT_SCENE_MOREAU,        /* with Poisson's law or Newton's */
    IMPACT_SCENE_SEQUENCE       /* one after another, in the order of the bodies */
} impact_scene_together;

/* How bodies are moved that touch each other and do not settle. */
typedef enum impact_piles {
    IMPACT_PILES_AUTO,  /* exactly; by steps once that takes the integrator 4000 steps for a fall of one radius */
    IMPACT_PILES_EXACT, /* exactly, however long it takes */
    IMPACT_PILES_STEPS  /* by steps, from the start until all rests */
} impact_piles;

/* Which bodies have a row at k/output_rate. */
typedef enum impact_samples {
    IMPACT_SAMPLES_ALL, /* every one that is not static: the same bodies at each time */
    /* Those that move. One that has come to rest has a row the first time after that, and at the definition's duration;
     * beside each event all have theirs, so that what is left out stands as in the row before */
    IMPACT_SAMPLES_MOVING
} impact_samples;

/* How bodies move between events. */
typedef enum impact_motion_method {
    IMPACT_MOTION_AUTO,  /* in closed form where there is one: flight, with damping too, and balls that roll or slide;
                          * else flight and what is held at one contact by collocation, IMPACT_ODE_LOBATTO; slip
                          * that dies out and what many contacts hold by IMPACT_ODE_DOP853; what lies on flat
                          * places of superquadrics, slip that begins and what is stiff by CVODE; piles as `piles`
                          * says */
    IMPACT_MOTION_CVODE, /* all that moves by CVODE, flight too; no pile by steps */
    IMPACT_MOTION_RK4, /* all that moves by the classical Runge-Kutta method with the fixed `step`; no pile by steps */
    IMPACT_MOTION_STEPS, /* AUTO, and piles by steps from the start: piles = IMPACT_PILES_STEPS */
    IMPACT_MOTION_OTHER  /* as CVODE, each stretch by that of Adams and BDF which CVODE would not take: what vouches for
                          * a  run; no pile by steps */
} impact_motion_method;

/* How gaps without a closed form are found. */
typedef enum impact_gap_method {
    IMPACT_GAP_NEWTON, /* impact_gap */
    IMPACT_GAP_CCD     /* impact_gap_ccd, as it comes; a run whose query fails its check ends with IMPACT_EUNSETTLED */
} impact_gap_method;

/* The methods of a scene. Together motion = CVODE, impacts = CVODE and gaps = CCD are the textbook's construction:
 * GJK and EPA on support functions, an integrator with root-finding between impacts and through each. IMPACT_EARGUMENT,
 * with a message: one that is of no use beside the others, or out of its range; IMPACT_EABSENT: one that this build
 * lacks. */
typedef struct impact_methods {
    impact_motion_method motion;
    impact_solver impacts; /* the same as the definition's `solver`: one of them may be given, or both alike */
    impact_gap_method gaps;
    double tolerance;        /* the same as the definition's; 0: that one */
    double impact_tolerance; /* of CVODE in impacts, in [1e-14, 1e-2]; 0: tolerance, and 1e-14 with compliance */
    double gap_tolerance;    /* of libccd, in [1e-7, 1e-2], in units of the larger body; 0: libccd's own, 1e-4 */
    double step;             /* s, > 0, of RK4; 0 of the others */
} impact_methods;

typedef struct impact_scene_def {
    size_t struct_size;
    const char *name;
    qvec3 gravity;      /* m/s^2 */
    double duration;    /* s, > 0 */
    double output_rate; /* samples per second; 0: none but those beside events */

    const impact_body_def *bodies;
    int body_count;
    const impact_force_def *forces;
    int force_count;
    const impact_pair_def *pairs;
    int pair_count;

    impact_pair_rule friction_rule, restitution_rule;
    impact_law law;
    impact_solver solver; /* of impacts; a short name of methods.impacts */
    double compliance;    /* of every contact, eta^2: see impact_collision; > 0 with Stronge's law only; 0: rigid */

    double tolerance; /* relative, of the motion's integration (a short name of methods.tolerance); a thirtieth of it
                         where no contact is held */
    /* m: a bounce that would rise less than this, than a few roundings of the gap, or than the integrator can tell, is
     * the last: the contact is held; a body that rocks on a flat face with less energy than lifts it by a hundred of
     * this lies there */
    double rest_height;
    double rest_speed; /* m/s (and rad/s times the bounding radius): slower than this and unaccelerated is at rest */
    long max_events;   /* IMPACT_EVENT_LIMIT after so many */
    long max_steps;    /* IMPACT_EUNSETTLED after so many stretches of motion and steps of integrators */
    const impact_allocator
        *allocator; /* of all memory the scene takes, and its limit; copied; NULL: malloc (memory.h) */
    /* of the recorder's keys, in [1e-14, 1e-2]: part of a body's bounding radius in place, rad in orientation */
    double key_tolerance;
    impact_piles piles;
    impact_scene_together together;
    impact_samples samples;
    impact_methods methods;
    /* in [1e-9, 1e-2], of the smallest radius of an island that moves by steps: what one of them may err */
    double pile_tolerance;
} impact_scene_def;

/* The same defaults into a struct of struct_size bytes: what it is short of is left out, what it has beyond is zero. */
IMPACT_API void impact_fill_scene_def(impact_scene_def *def, size_t struct_size);
IMPACT_API void impact_fill_body_def(impact_body_def *def, size_t struct_size);
IMPACT_API void impact_fill_pair_def(impact_pair_def *def, size_t struct_size);

/* Every default in one place (scene_defaults.c): Earth's gravity, 1 kg/dm^3, product rules (as in the thesis),
 * Poisson's law, tolerance 1e-13, rest_height 1e-12 m, rest_speed 1e-9 m/s, 24 samples per second, a million events,
 * 1e8 steps, key_tolerance 1e-10, pile_tolerance 1e-3, every body's samples. */
IMPACT_INLINE impact_scene_def impact_default_scene_def(void)
{
    impact_scene_def def;
    impact_fill_scene_def(&def, sizeof def);
    return def;
}
IMPACT_INLINE impact_body_def impact_default_body_def(void)
{
    impact_body_def def;
    impact_fill_body_def(&def, sizeof def);
    return def;
}
IMPACT_INLINE impact_pair_def impact_default_pair_def(const char *body1, const char *body2)
{
    impact_pair_def def;
    impact_fill_pair_def(&def, sizeof def);
    def.body1 = body1;
    def.body2 = body2;
    return def;
}

typedef struct impact_scene impact_scene;

/* *scene is NULL on failure, and message (may be NULL) says what is wrong with which body, key and value. */
/* IMPACT_EDOMAIN under flush-to-zero or denormals-are-zero. A host's floating-point traps are switched off within
 * impact_scene_create and a run, its callbacks included, and its environment is given back as it was, with its flags.
 * IMPACT_ENOMEM, here and in a run, says how much was wanted. After it a run can go on no more. */
IMPACT_API impact_status impact_scene_create(const impact_scene_def *def, impact_scene **scene, char *message,
                                             unsigned long message_size);
IMPACT_API void impact_scene_destroy(impact_scene *scene); /* NULL is fine */

/* Runs on to the definition's duration, or to time t, which is not over. Rows go to the recorder (NULL: nowhere).
 * Samples stand at k/output_rate; two more, just before and just after, beside each event, for the bodies in it.
 * IMPACT_OK: the time was reached; IMPACT_AT_REST: nothing moves any more and nothing will, state stands until the end:
 * impact_scene_time is then when all had come to rest after a run to the duration, and t after one to t;
 * IMPACT_SOFT: one of these, but the scene's receipt failed (impact_scene_receipt and the message), or an impact was
 * soft (usage); other positive statuses: stopped early; negative: failed. See impact_scene_message. A scene at rest or
 * stopped can be run on. */
IMPACT_API impact_status impact_scene_run(impact_scene *scene, const impact_recorder *recorder);
IMPACT_API impact_status impact_scene_run_to(impact_scene *scene, double t, const impact_recorder *recorder);

/* Runs on to the next instant at which there is an event, and through all that happens at it; to t_max at most, which
 * is not over. *event (NULL: unwanted) is the first of that instant, body1 -1 where none came by t_max; the recorder
 * (NULL: nowhere) gets every row on the way. Its words live until the next step. Returns as impact_scene_run_to to the
 * event's time does, and changes no more bits than that: none. */
IMPACT_API impact_status impact_scene_step(impact_scene *scene, double t_max, const impact_recorder *recorder,
                                           impact_event *event);

/* Contacts held now, with the forces that hold them now, those of resting bodies too; fills up to `room` of them (held
 * may be NULL for 0) and returns how many there are, in the order of no promise but the same for the same scene; below
 * 0 a status: IMPACT_ENOMEM, or IMPACT_EDOMAIN where a custom force refuses. Where reactions are not unique it is one
 * choice of them. Before a run begins nothing is held. Changes no bit of the motion. */
IMPACT_API int impact_scene_held(const impact_scene *scene, impact_held *held, int room);

/* Puts a body that moves into another state, now: position, orientation (normalised), velocity and omega of the sample;
 * its t, body and name do not count. What held the body is let go, what it touches there is settled as at a start
 * (of several that touch each other put all away first: one set beside one that is still elsewhere may strike it);
 * all else goes on with the same bits. The energy that comes or goes is work of forces in the account. Events of the
 * change are counted (usage) and go to no recorder.
 * IMPACT_EDOMAIN: a number is not finite, or the body would overlap another: the message names both; IMPACT_EARGUMENT:
 * there is no such body, it is static, its orientation is zero, or its energy lies beyond double precision. Nothing is
 * changed then. Other failures are those of a run. */
IMPACT_API impact_status impact_scene_set_state(impact_scene *scene, int body, const impact_sample *state);

/* Gives a body that moves an impulse, N s, world, at a point, m, world, now: v += impulse/mass, L += (point - x) x
 * impulse. With the contacts it holds that is an encounter: where it drives bodies together they answer by the law of
 * impact, where it drives them apart they part. Its work is the forces' in the account. Events are counted (usage) and
 * go to no recorder. Fails as impact_scene_set_state. */
IMPACT_API impact_status impact_scene_push(impact_scene *scene, int body, qvec3 impulse, qvec3 point);

/* Saves all that decides how the scene goes on, and its books. bytes NULL: *size is set to how many there will be,
 * nothing changes. Else *size is the room in bytes, IMPACT_EARGUMENT where that is too little, and is set to how many
 * were written. An integrator's history is not saved: what an integrator or a pile's steps move departs anew from where
 * it is, in the scene that is saved too, so that both go on with the same bits; what flies, damped or not, and what
 * rests goes on with the bits of the run without a save. IMPACT_EARGUMENT: its run has failed, or was stopped amid an
 * instant.
 */
IMPACT_API impact_status impact_scene_save(impact_scene *scene, void *bytes, size_t *size);

/* Goes on from what was saved: of a scene made of the same definition (but for max_events, max_steps, key_tolerance and
 * the allocator) by the same version of the library, whatever this one has done meanwhile; custom forces call this
 * scene's functions. A recorder's rows begin anew at that time. IMPACT_EARGUMENT, with a message: any changed byte, a
 * part of the bytes, another scene's, numbers that can be no state of it; nothing is changed then. IMPACT_ENOMEM, and
 * other failures where the motion departs: the scene can run on no more. */
IMPACT_API impact_status impact_scene_load(impact_scene *scene, const void *bytes, size_t size);

/* The last message, with numbers; "" when there was none. */
IMPACT_API const char *impact_scene_message(const impact_scene *scene);
IMPACT_API double impact_scene_time(const impact_scene *scene);
IMPACT_API const char *impact_scene_name(const impact_scene *scene); /* the definition's; lives as long as the scene */
/* Index of the body so named, or -1. */
IMPACT_API int impact_scene_find(const impact_scene *scene, const char *body);
/* The body's state now. IMPACT_EARGUMENT when there is no such body. */
IMPACT_API impact_status impact_scene_body(const impact_scene *scene, int body, impact_sample *sample);

/* What was defined, as the scene holds it: mass and moments are numbers (of a static body infinite and zero), density
 * is NaN, position and orientation are those of now, and name lives as long as the scene. def->struct_size is to be
 * set: begin with impact_default_body_def(). IMPACT_EARGUMENT when it is not, or when there is no such body. */
IMPACT_API int impact_scene_body_count(const impact_scene *scene);
IMPACT_API impact_status impact_scene_body_def(const impact_scene *scene, int body, impact_body_def *def);
IMPACT_API qvec3 impact_scene_gravity(const impact_scene *scene);
/* The name of a scene's force, as its events have it; NULL when there is no such force. */
IMPACT_API const char *impact_scene_force_name(const impact_scene *scene, int force);
IMPACT_API double impact_scene_key_tolerance(const impact_scene *scene);

/* What the run used; each is 0 where the scene does not need it. */
typedef struct impact_usage {
    long ballistic_flights; /* stretches of flight in closed form */
    long rolls;             /* stretches in which a ball rolls or slides on a plane, in closed form */
    long glides; /* stretches of a body that lies on a face and moves: in closed form, which `rolls` counts too, or by
                  * collocation at Gauss's nodes (docs/faces.md), whatever `motion` says */
    long integrators; /* integrators created for the motion */
    long integrator_starts, integrator_steps, integrator_rhs_calls;
    long gap_closed_form, gap_newton, gap_gjk, gap_fallback, gap_ccd; /* gap queries, by the road that answered */
    long impacts_closed_form, impacts_series, impacts_cvode;          /* impacts, by solver */
    long impacts_second, impacts_soft; /* of these, answered in 128 bits; answered though no receipt passed */
    long impacts_gaining;              /* answers that gave bodies energy, as their law may: energy_rose */
    long impacts_turning;              /* impacts of pairs with torsional or rolling friction, of none of the solvers */
    /* of these, answers to another impact in the same instant, one after another in the order of the definition */
    long impacts_simultaneous;
    long lifts_chosen;     /* sliding contacts that lifted off where their friction could have pressed them too */
    long encounters;       /* instants whose contacts were answered together, and */
    long impacts_together; /* the impulses that they exchanged */
    /* instants after which bodies moved on with reactions of friction that are not unique: what follows hangs on the
     * choice */
    long reactions_chosen;
    long islands_stepped; /* stretches of motion by steps, see impact_piles, and the steps they took */
    long pile_steps;
    long events[IMPACT_EVENT_REST + 1]; /* by kind */
    long samples;
    long keys;
    long keys_unmet; /* of these, so close in time that the tolerance was not met before them */
} impact_usage;

IMPACT_API impact_usage impact_scene_usage(const impact_scene *scene);
IMPACT_API impact_memory impact_scene_memory(const impact_scene *scene); /* what it holds now */
/* Its counts by number, from 0, each with its name above, but for the events; false: there is none of this number. */
IMPACT_API bool impact_usage_entry(const impact_usage *usage, int number, const char **name, long *value);

/* m: how far places may be off because bodies moved by steps, at most so far. The scene is moved on twice from its
 * first step, once by steps that may err ten times as much; where any point of a body was then, farthest from where it
 * is, five times. 0 where nothing was stepped. What a host changes meanwhile is changed in both. */
IMPACT_API double impact_scene_pile_error(const impact_scene *scene);
/* s: from when that is no measure any more, as it was a tenth of a body's radius, or the second found no
 * answer: motion that others, as right, leave; infinite: it is one to the end. */
IMPACT_API double impact_scene_pile_parted(const impact_scene *scene);

/* The energy account, J: kinetic + potential = start + work of forces and of drives - the losses, to the tolerance of
 * the run. */
typedef struct impact_energy {
    double start;                                   /* kinetic + potential at t = 0 */
    double kinetic, potential;                      /* now; potential of uniform gravity and of attraction */
    double force_work;                              /* done by wind, custom forces, pushes and set states */
    double drive_work;                              /* done by static bodies whose surface moves */
    double damping_loss, sliding_loss, impact_loss; /* each >= 0 */
} impact_energy;

/* What the scene finds when it looks at its own answer, after every event and at the end: the worst of the run so far,
 * by identities that the solvers do not use. */
typedef struct impact_scene_residuals {
    double begin, end; /* s: of the stretch looked at last */
    long stretches;    /* looked at so far */
    double unit;       /* | |q| - 1 | of an orientation */
    double gap;        /* |gap| of a held contact, over the size of the places it is made of */
    double contact;    /* how far held contacts' forces leave their cone (pull, or rub more than the friction), over the
                        * greatest of them */
    double energy;     /* what the energy account is off by, over the greatest term in it */
    double momentum; /* of impacts: what the bodies' momentum changed by beyond what static ones gave, over its terms */
    double loss_fallen; /* J: by how much sliding_loss, damping_loss and impact_loss have fallen, each fall added up */
    double limit_unit, limit_gap, limit_contact, limit_energy, limit_momentum; /* what is good; loss_fallen's is
                                                                                * limit_energy too, over the greatest
                                                                                * term */
    const char *failed;              /* the first field that was not; NULL: none was */
    double failed_begin, failed_end; /* s: in which stretch */
} impact_scene_residuals;

/* IMPACT_OK, or IMPACT_SOFT where the receipt has failed. */
IMPACT_API impact_status impact_scene_receipt(const impact_scene *scene, impact_scene_residuals *residuals);

IMPACT_API impact_energy impact_scene_energy(const impact_scene *scene);

#ifdef __cplusplus
}
#endif

#endif
