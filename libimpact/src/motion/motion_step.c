/* SPDX-License-Identifier: MIT
 *
 * A step of the integrator as a segment: its polynomial, and the states, works and contacts at a time in it.
 */
#include "motion/motion_stretch.h"

#include <string.h>

/* Nothing moved: the state alone. */
static void keep_still(imp_dense *dense, const double *y)
{
    dense->terms = 1;
    dense->h = 0;
    memcpy(dense->c, y, sizeof *y * (size_t)dense->size);
}

impact_status imp_motion_keep_step(imp_motion *motion, double t0, double t1)
{
    imp_dense *dense = &motion->dense;
    const impact_status status =
        imp_dense_reserve(dense, motion->world->arena, motion->size, motion->world->body_count);
    if (status != IMPACT_OK) return status;
    double begin;
    impact_ode_last_step(motion->ode, &begin, &dense->end);
    dense->h = dense->end - begin;
    dense->t0 = t0, dense->t1 = t1;
    dense->size = motion->size;
    dense->clocked = imp_motion_clocked(motion);
    dense->stepped = false;
    dense->fixed = motion->ode == motion->rk4 || motion->ode == motion->lobatto || motion->ode == motion->dop853;
    if (!(t1 > t0)) {
        keep_still(dense, motion->y);
        return IMPACT_OK;
    }
    double scale = 1;
    for (dense->terms = 0; dense->terms < IMP_DENSE_TERMS; dense->terms++) {
        double *c = dense->c + (size_t)dense->terms * (size_t)dense->size;
        if (impact_ode_interpolate(motion->ode, dense->end, dense->terms, c) != IMPACT_OK) break;
        for (int i = 0; i < dense->size; i++) c[i] *= scale;
        scale *= dense->h / (dense->terms + 1);
    }
    return dense->terms > 0 ? IMPACT_OK : IMPACT_EINTEGRATOR;
}

imp_works imp_motion_works_of(const imp_motion *motion, const double *y)
{
    const double drive = motion->world->driven ? y[imp_motion_drive(motion)] : motion->works.drive;
    return (imp_works){y[Y_FORCE_WORK], y[Y_DAMPING], y[Y_SLIDING], drive};
}

imp_works imp_motion_works(const imp_motion *motion, double t)
{
    double y[Y_BODIES], drive = motion->works.drive;
    imp_dense_at(&motion->dense, t, 0, Y_BODIES, y);
    if (motion->world->driven) imp_dense_at(&motion->dense, t, imp_motion_drive(motion), 1, &drive);
    return (imp_works){y[Y_FORCE_WORK], y[Y_DAMPING], y[Y_SLIDING], drive};
}

bool imp_motion_keep_contacts(imp_motion *motion)
{
    imp_arena *arena = motion->world->arena;
    const int contacts = motion->held.count, pairs = motion->world->pair_count;
    imp_held_contact *kept =
        imp_arena_grow(arena, motion->kept_contacts, &motion->kept_room[0], contacts, sizeof *kept);
    if (kept) motion->kept_contacts = kept;
    imp_pair *kept_pairs = imp_arena_grow(arena, motion->kept_pairs, &motion->kept_room[1], pairs, sizeof *kept_pairs);
    if (kept_pairs) motion->kept_pairs = kept_pairs;
    if (!kept || !kept_pairs) return false;
    if (contacts > 0) memcpy(kept, motion->held.contacts, sizeof *kept * (size_t)contacts);
    memcpy(kept_pairs, motion->world->pairs, sizeof *kept_pairs * (size_t)pairs);
    return true;
}

void imp_motion_restore_contacts(imp_motion *motion)
{
    const size_t contacts = (size_t)motion->held.count;
    if (contacts > 0) memcpy(motion->held.contacts, motion->kept_contacts, sizeof *motion->kept_contacts * contacts);
    memcpy(motion->world->pairs, motion->kept_pairs, sizeof *motion->kept_pairs * (size_t)motion->world->pair_count);
}

/* The contacts stay as they are: what they press with was told before. */
impact_status imp_motion_put_back(imp_motion *motion, double t, imp_state *states)
{
    if (motion->held.count == 0) return IMPACT_OK;
    if (!imp_motion_keep_contacts(motion)) return IMPACT_ENOMEM;
    const bool loaded = imp_motion_load(motion, t, states);
    if (loaded) imp_held_project(&motion->held, motion->world, states, motion->loads);
    imp_motion_restore_contacts(motion);
    return loaded ? IMPACT_OK : IMPACT_EDOMAIN;
}

void imp_motion_go_to(imp_motion *motion, double t, imp_state *states)
{
    if (t == motion->dense.t1) return; /* the states are there */
    imp_dense_at(&motion->dense, t, 0, motion->size, motion->kept);
    imp_motion_unpack(motion, motion->kept, states);
    motion->works = imp_motion_works_of(motion, motion->kept);
}

impact_status imp_motion_look(imp_motion *motion, double t, imp_state *states)
{
    const bool held = motion->held.count > 0;
    if (held && !imp_motion_keep_contacts(motion)) return IMPACT_ENOMEM;
    imp_dense_at(&motion->dense, t, 0, motion->size, motion->kept);
    imp_motion_unpack(motion, motion->kept, states);
    if (!held) return IMPACT_OK;
    const bool loaded = imp_motion_load(motion, t, states);
    if (loaded) imp_held_project(&motion->held, motion->world, states, motion->loads);
    imp_motion_restore_contacts(motion);
    return loaded ? IMPACT_OK : IMPACT_EDOMAIN;
}

/* Where the contacts stand at t in the last step, as its polynomial has them: it goes with the bodies' states there. */
static void go_on_feet(imp_motion *motion, double t)
{
    imp_dense_at(&motion->dense, t, 0, motion->size, motion->kept);
    imp_motion_unpack(motion, motion->kept, motion->scratch);
}

impact_status imp_motion_contacts(imp_motion *motion, double t, bool moves, const imp_state *states,
                                  imp_held_contact *contacts)
{
    imp_held *held = &motion->held;
    const impact_usage usage = motion->world->usage;
    if (held->count == 0) return IMPACT_OK;
    if (!imp_motion_keep_contacts(motion)) return IMPACT_ENOMEM;
    if (moves) go_on_feet(motion, t);
    const bool loaded = imp_motion_load(motion, t, states);
    if (loaded) imp_held_solve(held, motion->world, states, motion->loads);
    memcpy(contacts, held->contacts, sizeof *contacts * (size_t)held->count);
    imp_motion_restore_contacts(motion);
    motion->world->usage = usage;
    return loaded ? IMPACT_OK : IMPACT_EDOMAIN;
}
