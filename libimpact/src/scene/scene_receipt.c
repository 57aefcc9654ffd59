/* SPDX-License-Identifier: MIT
 *
 * Identities that the solvers of the motion do not use: orientations are unit, what is held touches, contact forces lie
 * in their cones, energy is where the account says, and losses do not fall. A wrong impact or a wrong reaction cannot
 * hide: what it gives shows as a loss that falls.
 */
#include "scene/scene_receipt.h"
#include "scene/scene_meeting.h"
#include "world/world_gap.h"

#include <stdio.h>
#include <string.h>

void imp_scene_receipt_begin(impact_scene *scene)
{
    const double tolerance = scene->motion.tolerance;
    scene->receipt = (impact_scene_residuals){.limit_unit = IMP_RECEIPT_UNIT,
                                              .limit_gap = IMP_RECEIPT_GAP + IMP_RECEIPT_ERRORS * tolerance,
                                              .limit_contact = IMP_RECEIPT_CONTACT,
                                              .limit_energy = IMP_RECEIPT_ENERGY + IMP_RECEIPT_ERRORS * tolerance};
}

/* A NaN is no good. */
static void look_at(impact_scene *scene, const char *field, double *worst, double value, double limit)
{
    impact_scene_residuals *r = &scene->receipt;
    if (!(value <= *worst)) *worst = value;
    if (r->failed || value <= limit) return;
    r->failed = field;
    r->failed_begin = r->begin, r->failed_end = r->end;
}

static double worst_unit(const impact_scene *scene)
{
    double worst = 0;
    for (int i = 0; i < scene->world.body_count; i++) worst = fmax(worst, fabs(quat_norm(scene->states[i].q) - 1));
    return worst;
}

/* The kernel's gap of what is held, asked with a pair of its own: what is found does not touch the run. */
static double worst_gap(impact_scene *scene)
{
    imp_world *world = &scene->world;
    const impact_usage usage = world->usage;
    double worst = 0;
    for (int p = 0; p < world->pair_count; p++) {
        imp_pair pair = world->pairs[p];
        if (!imp_is_held(&pair)) continue;
        impact_contact contact;
        imp_world_gap(world, &pair, scene->states, &contact);
        worst = fmax(worst, fabs(contact.gap) / imp_world_place_scale(world, &pair, scene->states));
    }
    world->usage = usage;
    return worst;
}

static double worst_contact(impact_scene *scene)
{
    imp_persist *persist = &scene->motion.persist;
    double greatest = 0, worst = 0;
    if (persist->count == 0 || imp_scene_load(scene) != IMPACT_OK) return 0;
    imp_persist_solve(persist, &scene->world, scene->states, scene->motion.loads);
    for (int c = 0; c < persist->count; c++) greatest = fmax(greatest, qvec3_norm(persist->touches[c].force));
    for (int c = 0; c < persist->count; c++) {
        const imp_touch *touch = &persist->touches[c];
        const double normal = qvec3_dot(touch->normal, touch->force);
        const double rubs = qvec3_norm(qvec3_axpy(-normal, touch->normal, touch->force));
        worst = fmax(worst, fmax(-normal, rubs - touch->friction * fmax(normal, 0)));
    }
    return greatest > 0 ? worst / greatest : 0;
}

/* What the account is off by, and the greatest term that it has had. */
static double account(impact_scene *scene, double *scale)
{
    const impact_energy e = impact_scene_energy(scene);
    const double losses = e.damping_loss + e.sliding_loss + e.impact_loss, now = e.kinetic + e.potential;
    const double given = fmax(fabs(e.force_work), fabs(e.drive_work));
    const double greatest = fmax(fmax(fabs(e.start), e.kinetic), fmax(fabs(e.potential), fmax(given, fabs(losses))));
    *scale = scene->greatest_energy = fmax(scene->greatest_energy, greatest);
    return now - (e.start + e.force_work + e.drive_work - losses);
}

/* What impacts took must not come back; friction's and damping's part is seen step by step (motion_guard). */
static double fallen(impact_scene *scene)
{
    if (scene->impact_loss < scene->impact_loss_before)
        scene->impact_loss_fallen += scene->impact_loss_before - scene->impact_loss;
    scene->impact_loss_before = scene->impact_loss;
    return scene->impact_loss_fallen + scene->motion.fallen;
}

void imp_scene_receipt_look(impact_scene *scene, double begin)
{
    impact_scene_residuals *r = &scene->receipt;
    double scale;
    const double off = account(scene, &scale);
    r->begin = begin, r->end = scene->t;
    r->stretches++;
    look_at(scene, "unit", &r->unit, worst_unit(scene), r->limit_unit);
    look_at(scene, "gap", &r->gap, worst_gap(scene), r->limit_gap);
    look_at(scene, "contact", &r->contact, worst_contact(scene), r->limit_contact);
    look_at(scene, "energy", &r->energy, scale > 0 ? fabs(off) / scale : fabs(off), r->limit_energy);
    look_at(scene, "loss_fallen", &r->loss_fallen, fallen(scene), r->limit_energy * scale);
}

void imp_scene_receipt_add(impact_scene *scene, const impact_scene *part)
{
    impact_scene_residuals *sum = &scene->receipt;
    const impact_scene_residuals *r = &part->receipt;
    sum->stretches += r->stretches;
    sum->unit = fmax(sum->unit, r->unit);
    sum->gap = fmax(sum->gap, r->gap);
    sum->contact = fmax(sum->contact, r->contact);
    scene->greatest_energy = fmax(scene->greatest_energy, part->greatest_energy);
    scene->motion.fallen += part->motion.fallen;
    scene->impact_loss_fallen += part->impact_loss_fallen;
    scene->impact_loss_before += part->impact_loss;
    if (sum->failed || !r->failed) return;
    sum->failed = r->failed;
    sum->failed_begin = r->failed_begin, sum->failed_end = r->failed_end;
}

impact_status imp_scene_receipt_judge(impact_scene *scene, impact_status status)
{
    const impact_scene_residuals *r = &scene->receipt;
    if (status != IMPACT_OK && status != IMPACT_AT_REST) return status;
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
