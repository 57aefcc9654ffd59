/* SPDX-License-Identifier: MIT
 *
 * Identities that the solvers of the motion do not use: orientations are unit, what is held contacts, contact forces
 * lie in their cones, energy is where the account says, losses do not fall, and impacts change the bodies' momentum by
 * what static ones gave, all impulses between bodies being equal and opposite. A wrong impact or a wrong reaction
 * cannot hide: what it gives shows as a loss that falls.
 */
#include "scene/scene_receipt.h"
#include "scene/scene_meeting.h"
#include "base/numbers.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <string.h>

void imp_scene_receipt_begin(impact_scene *scene)
{
    const double tolerance = scene->methods.tolerance;
    scene->receipt = (impact_scene_residuals){.limit_unit = IMP_RECEIPT_UNIT,
                                              .limit_gap = IMP_RECEIPT_GAP + IMP_RECEIPT_ERRORS * tolerance,
                                              .limit_contact = IMP_RECEIPT_CONTACT,
                                              .limit_energy = IMP_RECEIPT_ENERGY + IMP_RECEIPT_ERRORS * tolerance,
                                              .limit_momentum = IMP_RECEIPT_MOMENTUM};
}

/* A NaN is no good. */
static void look_at(impact_scene *scene, const char *field, double *worst, double value, double limit)
{
    impact_scene_residuals *r = &scene->receipt;
    *worst = imp_worse(*worst, value);
    if (r->failed || value <= limit) return;
    r->failed = field;
    r->failed_begin = r->begin, r->failed_end = r->end;
}

static double worst_unit(const imp_island *island, const imp_state *states)
{
    double worst = 0;
    for (int i = 0; i < island->world.body_count; i++)
        if (!island->world.bodies[i].is_static) worst = imp_worse(worst, fabs(quat_dot(states[i].q, states[i].q) - 1));
    return 0.5 * worst; /* | |q| - 1 |, but for its square */
}

/* The kernel's gap of what is held, asked with a pair of its own: what is found does not touch the run. */
static double worst_gap(imp_island *island, const imp_state *states)
{
    imp_world *world = &island->world;
    const impact_usage usage = world->usage;
    double worst = 0;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair pair = world->pairs[p];
        if (!imp_is_held(&pair)) continue;
        pair.site.corner = 0; /* all of the body: no other corner may be below */
        impact_contact contact;
        imp_world_gap(world, &pair, states, &contact);
        worst = imp_worse(worst, fabs(contact.gap) / imp_world_place_scale(world, &pair, states));
    }
    world->usage = usage;
    return worst;
}

/* What goes on by steps from here was settled by nobody: what was held is held no more. */
static double worst_contact(imp_island *island)
{
    imp_held *held = &island->motion.held;
    double greatest = 0, worst = 0;
    if (island->lies || held->count == 0 || imp_scene_load(island) != IMPACT_OK) return 0;
    imp_held_solve(held, &island->world, island->states, island->motion.loads);
    for (int c = 0; c < held->count; c++) greatest = fmax(greatest, qvec3_norm(held->contacts[c].force));
    for (int c = 0; c < held->count; c++) {
        const imp_held_contact *contact = &held->contacts[c];
        const double normal = qvec3_dot(contact->normal, contact->force);
        const double rubs = qvec3_norm(qvec3_axpy(-normal, contact->normal, contact->force));
        worst = imp_worse(imp_worse(worst, -normal), rubs - contact->friction * fmax(normal, 0));
    }
    return greatest > 0 ? worst / greatest : 0;
}

static double largest_of(double a, double b, double c, double d)
{
    return fmax(fmax(fabs(a), fabs(b)), fmax(fabs(c), fabs(d)));
}

/* What impacts took must not come back, but for what their law gave, as Newton's of restitution may (energy_rose);
 * friction's and damping's part is seen step by step (motion_guard). */
static double fallen(imp_island *island)
{
    impact_scene *scene = island->scene;
    scene->impact_loss_fallen += fmax(0, island->loss_before - island->impact_loss - island->gained);
    island->loss_before = island->impact_loss;
    island->gained = 0;
    return scene->impact_loss_fallen + scene->sliding_fallen + island->motion.fallen;
}

/* J, of falls by the bodies' own radii: where nothing has energy yet what is none is told by these. */
static double energy_of_falls(const imp_world *world)
{
    double sum = 0;
    for (int i = 0; i < world->body_count; i++)
        if (!world->bodies[i].is_static) sum += world->bodies[i].mass * world->bodies[i].radius;
    return sum * qvec3_norm(world->gravity);
}

void imp_scene_receipt_look(imp_island *island)
{
    impact_scene *scene = island->scene;
    impact_scene_residuals *r = &scene->receipt;
    const imp_works *works = &island->motion.works;
    const double taken = works->damping + works->sliding + island->impact_loss, given = works->force + works->drive;
    const double energy = imp_island_energy(island), off = energy + taken - given - island->balance;
    scene->greatest_energy = fmax(scene->greatest_energy, largest_of(energy, works->force, works->drive, taken));
    const double scale = scene->greatest_energy;
    r->begin = island->looked_at, r->end = island->looked_at = island->t;
    r->stretches++;
    look_at(scene, "unit", &r->unit, worst_unit(island, island->states), r->limit_unit);
    look_at(scene, "gap", &r->gap, worst_gap(island, island->states), r->limit_gap);
    look_at(scene, "contact", &r->contact, worst_contact(island), r->limit_contact);
    look_at(scene, "energy", &r->energy, scale > 0 ? fabs(off) / scale : fabs(off), r->limit_energy);
    look_at(scene, "momentum", &r->momentum, island->pushed.off, r->limit_momentum);
    island->pushed.off = 0;
    look_at(scene, "loss_fallen", &r->loss_fallen, fallen(island),
            r->limit_energy * fmax(scale, energy_of_falls(&island->world)));
}

/* ---- the whole ---- */

/* What the account is off by, and the greatest term that it has had. */
static double account(impact_scene *scene, double *scale)
{
    const impact_energy e = impact_scene_energy(scene);
    const double losses = e.damping_loss + e.sliding_loss + e.impact_loss, now = e.kinetic + e.potential;
    const double greatest = fmax(largest_of(e.start, e.kinetic, e.potential, losses), fabs(e.drive_work));
    *scale = scene->greatest_energy = fmax(scene->greatest_energy, fmax(greatest, fabs(e.force_work)));
    return now - (e.start + e.force_work + e.drive_work - losses);
}

/* What no event has shown: islands as they are on their way, and all that flies. Reactions are not solved for: that
 * would leave its traces, and a run in parts is to be the whole, bit for bit. */
static void look_at_all(impact_scene *scene)
{
    impact_scene_residuals *r = &scene->receipt;
    double scale;
    r->begin = 0, r->end = scene->t;
    for (int k = 0; k < scene->island_count; k++) {
        imp_island *island = scene->islands[k];
        if (!island || island->stepped) continue;
        look_at(scene, "unit", &r->unit, worst_unit(island, island->motion.sampled), r->limit_unit);
        look_at(scene, "gap", &r->gap, worst_gap(island, island->motion.sampled), r->limit_gap);
    }
    const double off = account(scene, &scale);
    look_at(scene, "energy", &r->energy, scale > 0 ? fabs(off) / scale : fabs(off), r->limit_energy);
}

impact_status imp_scene_receipt_judge(impact_scene *scene, impact_status status)
{
    const impact_scene_residuals *r = &scene->receipt;
    if (status != IMPACT_OK && status != IMPACT_AT_REST) return status;
    look_at_all(scene);
    if (!r->failed) return scene->world.usage.impacts_soft > 0 ? IMPACT_SOFT : status;
    double scale;
    const double off = account(scene, &scale);
    char what[160] = "";
    if (strcmp(r->failed, "energy") == 0)
        snprintf(what, sizeof what, "the energy account is off by %.2g J of %.2g J", off, scale);
    if (strcmp(r->failed, "loss_fallen") == 0)
        snprintf(what, sizeof what, "losses of energy fell by %.2g J of %.2g J: reactions did work", r->loss_fallen,
                 scale);
    if (strcmp(r->failed, "gap") == 0)
        snprintf(what, sizeof what, "held contacts are apart or overlap by %.2g of their size", r->gap);
    if (strcmp(r->failed, "contact") == 0)
        snprintf(what, sizeof what, "contact forces leave their cone by %.2g of the greatest", r->contact);
    if (strcmp(r->failed, "momentum") == 0)
        snprintf(what, sizeof what, "impacts changed the momentum by %.2g of it more than static bodies gave",
                 r->momentum);
    if (strcmp(r->failed, "unit") == 0) snprintf(what, sizeof what, "orientations are off unit by %.2g", r->unit);
    snprintf(scene->message, sizeof scene->message, "%s, first between t = %.9g and %.9g: do not trust the digits",
             what, r->failed_begin, r->failed_end);
    return IMPACT_SOFT;
}

impact_status impact_scene_receipt(const impact_scene *scene, impact_scene_residuals *residuals)
{
    *residuals = scene->receipt;
    return scene->receipt.failed ? IMPACT_SOFT : IMPACT_OK;
}
