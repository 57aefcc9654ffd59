/* SPDX-License-Identifier: MIT
 *
 * record: samples, events and keys of a run, to a caller's sink or to CSV files (run.h: to one recorded run).
 */
#ifndef IMPACT_RECORD_H
#define IMPACT_RECORD_H

#include <quat/quat.h>
#include "memory.h"
#include "status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One body at one time; SI, world frame. */
typedef struct impact_sample {
    double t;
    int body;         /* index in the scene's definition */
    const char *name; /* lives as long as the scene */
    qvec3 position;
    quat orientation; /* body to world, unit; its sign is continuous along the run */
    qvec3 velocity;   /* of the centre */
    qvec3 omega;
} impact_sample;

typedef enum impact_event_kind {
    IMPACT_EVENT_IMPACT,  /* an impulse was exchanged */
    IMPACT_EVENT_CONTACT, /* bounces died out: the contact is held from here on */
    IMPACT_EVENT_SLIP,    /* a held contact begins to slide */
    IMPACT_EVENT_STICK,   /* sliding ends: the held contact rolls or rests */
    IMPACT_EVENT_LIFTOFF, /* a held contact opens */
    IMPACT_EVENT_FORCE,   /* a body crosses the edge of a force's reach */
    IMPACT_EVENT_REST     /* a body has come to rest */
} impact_event_kind;

/* The lower-case word for an event; never NULL. */
IMPACT_API const char *impact_event_name(impact_event_kind kind);

typedef struct impact_event {
    double t;
    impact_event_kind kind;
    int body1, body2;          /* indices; body2 = -1 when there is none */
    const char *name1, *name2; /* name2 = "" when there is none; for IMPACT_EVENT_FORCE the force's name */
    qvec3 point;               /* contact point, world; the body's centre when there is no contact */
    qvec3 normal;              /* from body 2 to body 1; zero when there is none */
    double impulse_normal, impulse_tangential; /* N s */
    qvec3 impulse;                             /* on body 1, world, N s; zero where none was exchanged */
    double normal_before, normal_after;        /* normal relative velocity, m/s */
    const char *phases;                        /* e.g. "slip-c stick-c stick-r"; "" when there are none */
    double energy_before, energy_after;        /* mechanical energy of the whole scene, J */
    long encounter; /* impacts that were answered together share a number, 1, 2, ...; 0: it was answered alone */
} impact_event;

/* What a body does from one of its keys to the next, T after the key. */
typedef enum impact_key_form {
    IMPACT_KEY_QUINTIC, /* the quintic Hermite polynomials of both keys, to the scene's key_tolerance (docs/run.md) */
    IMPACT_KEY_STEADY,  /* x + v T + a T^2/2, turned by omega T + alpha T^2/2, alpha along omega: by this key alone */
    IMPACT_KEY_FREE     /* flight with the body's own moments and damping, of which this key is the start */
} impact_key_form;

/* The lower-case word for it; never NULL. */
IMPACT_API const char *impact_key_form_name(impact_key_form form);

/* One body where its trajectory is pinned: until the next key no event touches it, and it moves by this one's form. Of
 * each body they come in order of time; two of one t stand before and after an event, where the motion before has no
 * closed form. SI, world frame. */
typedef struct impact_key {
    double t;
    int body;
    qvec3 position;
    quat orientation; /* unit; its sign is continuous along the run */
    qvec3 velocity, omega;
    qvec3 acceleration, alpha; /* their rates */
    impact_key_form form;
} impact_key;

typedef enum impact_hold { IMPACT_HOLD_OPEN, IMPACT_HOLD_SLIP, IMPACT_HOLD_STICK } impact_hold;

/* The lower-case word for it; never NULL. */
IMPACT_API const char *impact_hold_name(impact_hold mode);

/* A held contact at one time, for display: exact at that time, to be drawn by straight lines between rows.
 * IMPACT_HOLD_OPEN: it ends here. */
typedef struct impact_held {
    double t;
    int body1, body2;
    impact_hold mode;
    qvec3 point;  /* world */
    qvec3 normal; /* from body 2 to body 1 */
    qvec3 force;  /* on body 1, N */
    qvec3 moment; /* on body 1 about the point, N m: of torsional and rolling friction, and of a face's that goes by
                     steps, which acts nearer to its centre; of impact_scene_held, 0 in recorded rows */
} impact_held;

struct impact_energy;

/* Where a run's rows go: struct_size = sizeof(impact_recorder), a later version may have more functions at its end. Any
 * of them may be NULL. A sink returns false to stop the run with IMPACT_ESINK. */
typedef struct impact_recorder {
    size_t struct_size;
    void *context;
    bool (*sample)(void *context, const impact_sample *sample);
    bool (*event)(void *context, const impact_event *event);
    /* now and then; false stops the run with IMPACT_STOPPED; where that is amid an instant, of hundreds of impacts, it
     * can go on no more */
    bool (*progress)(void *context, double t, double t_end);
    bool (*key)(void *context, const impact_key *key);
    bool (*held)(void *context, const impact_held *contact);
    /* the energy account beside events, and about every hundredth of the run */
    bool (*account)(void *context, double t, const struct impact_energy *energy);
} impact_recorder;

/* Bytes that may still be written, by all who are given the same one. */
typedef struct impact_quota {
    unsigned long long left;
    bool spent; /* something was refused */
} impact_quota;

/* CSV sink. Its files have their names only once impact_csv_close gives them: until then they have none at all (Linux,
 * where the file system allows it: nothing is left of a process that is killed), or stand under "PATH.part". 17
 * significant digits, one header line, "\n", '.' whatever the locale; a text that a spreadsheet would take for a
 * formula (it begins with = + - @ tab or return) has an apostrophe before it, as has one that begins with an
 * apostrophe. samples: t,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz events:
 * t,event,body1,body2,px,py,pz,nx,ny,nz,impulse_n,impulse_t,un_before,un_after,phases,encounter,energy_before,
 * energy_after */
typedef struct impact_csv impact_csv;

typedef struct impact_csv_def {
    size_t struct_size;                     /* sizeof(impact_csv_def): a later version may have more fields */
    const char *samples_path, *events_path; /* either may be NULL */
    impact_quota *quota;                    /* outlives the sink; a row beyond it is refused; NULL: none */
    const impact_allocator *allocator;      /* copied; NULL: malloc (the C library's FILE beside it) */
} impact_csv_def;

/* IMPACT_ESINK when a file cannot be opened: message (may be NULL) names it and says why. IMPACT_EARGUMENT when both
 * are the same. IMPACT_ENOMEM. */
IMPACT_API impact_status impact_csv_open_with(const impact_csv_def *def, impact_csv **csv, char *message,
                                              unsigned long message_size);
/* The same without quota and allocator. */
IMPACT_API impact_status impact_csv_open(const char *samples_path, const char *events_path, impact_csv **csv,
                                         char *message, unsigned long message_size);
/* A recorder over it (no progress function); valid until the close. Where it refuses a row errno says why: EDQUOT for
 * the quota. */
IMPACT_API void impact_csv_fill_recorder(impact_csv *csv, impact_recorder *recorder, size_t struct_size);
IMPACT_INLINE impact_recorder impact_csv_recorder(impact_csv *csv)
{
    impact_recorder recorder;
    impact_csv_fill_recorder(csv, &recorder, sizeof recorder);
    return recorder;
}
IMPACT_API long impact_csv_rows(const impact_csv *csv); /* given to it, in both files */

/* What becomes of the files. */
typedef enum impact_csv_fate {
    IMPACT_CSV_DROP,   /* they are gone; what stood under their names before stays */
    IMPACT_CSV_KEEP,   /* they get their names, all or none; partial ones of a run before are removed */
    IMPACT_CSV_PARTIAL /* of a run that ended early: "NAME.partial.csv" for "NAME.csv", whole lines; none without rows
                        */
} impact_csv_fate;

/* IMPACT_ESINK when a file cannot be finished or named: message says which and why, and it is gone. NULL is fine. */
IMPACT_API impact_status impact_csv_close(impact_csv *csv, impact_csv_fate fate, char *message,
                                          unsigned long message_size);

#ifdef __cplusplus
}
#endif

#endif
