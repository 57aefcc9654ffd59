/* SPDX-License-Identifier: MIT
 *
 * W_ij = g_i . g_j with the rows g of G M^(-1/2): the same products whichever of i and j comes first, so that W is
 * symmetric and its bits know nothing of the contacts' order.
 */
#include "contact/cone_assemble.h"
#include "base/tolerances.h"

#include <math.h>
#include <string.h>

void imp_cone_find_axes(qvec3 normal, qvec3 axes[3])
{
    const double x = fabs(normal.x), y = fabs(normal.y), z = fabs(normal.z);
    const qvec3 least = x <= y && x <= z ? (qvec3){1, 0, 0} : y <= z ? (qvec3){0, 1, 0} : (qvec3){0, 0, 1};
    const qvec3 across = qvec3_cross(normal, least);
    axes[0] = normal;
    axes[1] = qvec3_scale(across, 1 / qvec3_norm(across));
    axes[2] = qvec3_cross(normal, axes[1]);
}

static void find_side(const imp_body *body, quat q, const imp_cone_contact *contact, qvec3 arm, double sign,
                      double side[3][6])
{
    const qvec3 *axes = contact->axes, rubs = qvec3_add(arm, contact->rub);
    const double linear = body->is_static ? 0 : sign * sqrt(body->inverse_mass);
    const qvec3 root = {sqrt(body->inverse_moments.x), sqrt(body->inverse_moments.y), sqrt(body->inverse_moments.z)};
    for (int k = 0; k < 3; k++) {
        const qvec3 torque = qvec3_cross(k == 0 ? arm : rubs, axes[k]);
        const qvec3 own = body->spherical ? torque : quat_rotate_inverse(q, torque);
        const double row[6] = {linear * axes[k].x,    linear * axes[k].y,    linear * axes[k].z,
                               sign * root.x * own.x, sign * root.y * own.y, sign * root.z * own.z};
        for (int l = 0; l < 6; l++) side[k][l] = body->is_static ? 0 : row[l];
    }
}

static void add_block(double a[3][6], double b[3][6], double *w, size_t width)
{
    for (size_t k = 0; k < 3; k++)
        for (size_t l = 0; l < 3; l++) {
            double sum = 0;
            for (int m = 0; m < 6; m++) sum += a[k][m] * b[l][m];
            w[k * width + l] += sum;
        }
}

void imp_cone_find_rows(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts, int count,
                        imp_cone_row *rows)
{
    for (int c = 0; c < count; c++) {
        const imp_cone_contact *own = &contacts[c];
        find_side(&world->bodies[own->body1], states[own->body1].q, own, own->arm1, 1, rows[c].side[0]);
        find_side(&world->bodies[own->body2], states[own->body2].q, own, own->arm2, -1, rows[c].side[1]);
    }
}

void imp_cone_assemble(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts, int count,
                       imp_cone_row *rows, double *w)
{
    const size_t width = 3 * (size_t)count;
    imp_cone_find_rows(world, states, contacts, count, rows);
    for (size_t i = 0; i < width * width; i++) w[i] = 0;
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) {
            const int one[2] = {contacts[i].body1, contacts[i].body2}, two[2] = {contacts[j].body1, contacts[j].body2};
            for (int s = 0; s < 2; s++)
                for (int t = 0; t < 2; t++)
                    if (one[s] == two[t] && !world->bodies[one[s]].is_static)
                        add_block(rows[i].side[s], rows[j].side[t], &w[3 * ((size_t)i * width + (size_t)j)], width);
        }
}

void imp_cone_assemble_normals(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts,
                               int count, imp_cone_row *rows, double *w)
{
    imp_cone_find_rows(world, states, contacts, count, rows);
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) {
            const int one[2] = {contacts[i].body1, contacts[i].body2}, two[2] = {contacts[j].body1, contacts[j].body2};
            double sum = 0;
            for (int s = 0; s < 2; s++)
                for (int t = 0; t < 2; t++)
                    if (one[s] == two[t] && !world->bodies[one[s]].is_static)
                        for (int k = 0; k < 6; k++) sum += rows[i].side[s][0][k] * rows[j].side[t][0][k];
            w[(size_t)i * (size_t)count + (size_t)j] = sum;
        }
}

static qvec3 turning_of(const imp_body *body, const imp_state *state)
{
    if (!body->is_static) return imp_omega(body, state);
    return body->driven ? body->spin : (qvec3){0, 0, 0};
}

/* How the bodies turn on each other. */
static qvec3 relative_turning(const imp_world *world, const imp_state *states, const imp_cone_contact *contact)
{
    return qvec3_sub(turning_of(&world->bodies[contact->body1], &states[contact->body1]),
                     turning_of(&world->bodies[contact->body2], &states[contact->body2]));
}

/* What the bodies' velocities are at the contact, along its axes. */
static void velocities_at(const imp_world *world, const imp_state *states, const imp_cone_contact *contact, double *u)
{
    const qvec3 v =
        qvec3_sub(imp_point_velocity(&world->bodies[contact->body1], &states[contact->body1], contact->arm1),
                  imp_point_velocity(&world->bodies[contact->body2], &states[contact->body2], contact->arm2));
    for (int k = 0; k < 3; k++) u[k] = qvec3_dot(contact->axes[k], v);
    if (!(qvec3_dot(contact->rub, contact->rub) > 0)) return;
    const qvec3 more = qvec3_cross(relative_turning(world, states, contact), contact->rub);
    for (int k = 1; k < 3; k++) u[k] += qvec3_dot(contact->axes[k], more);
}

void imp_cone_let_yield(double *w, int n)
{
    for (int i = 0; i < n; i++) w[i * (n + 1)] *= 1 + IMP_YIELDS;
}

void imp_cone_contact_velocities(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts,
                                 int count, double *u)
{
    for (int c = 0; c < count; c++) velocities_at(world, states, &contacts[c], &u[3 * c]);
}

static qvec3 sum_along(const imp_cone_contact *contact, const double *r)
{
    qvec3 p = {0, 0, 0};
    for (int k = 0; k < 3; k++) p = qvec3_axpy(r[k], contact->axes[k], p);
    return p;
}

/* Gives the bodies the impulses r along the axes there, and the moment. */
static void push_at(const imp_world *world, const imp_cone_contact *contact, const double *r, qvec3 moment,
                    imp_state *states)
{
    const int bodies[2] = {contact->body1, contact->body2};
    const qvec3 arms[2] = {contact->arm1, contact->arm2};
    const qvec3 rubs = qvec3_axpy(r[2], contact->axes[2], qvec3_scale(contact->axes[1], r[1]));
    qvec3 p = sum_along(contact, r);
    moment = qvec3_add(moment, qvec3_cross(contact->rub, rubs));
    for (int s = 0; s < 2; s++, p = qvec3_neg(p), moment = qvec3_neg(moment)) {
        if (world->bodies[bodies[s]].is_static) continue;
        imp_state *state = &states[bodies[s]];
        state->v = qvec3_axpy(world->bodies[bodies[s]].inverse_mass, p, state->v);
        state->momentum = qvec3_add(state->momentum, qvec3_add(qvec3_cross(arms[s], p), moment));
    }
}

void imp_cone_push(const imp_world *world, const imp_cone_contact *contacts, int count, const double *r,
                   imp_state *states)
{
    for (int c = 0; c < count; c++) push_at(world, &contacts[c], &r[3 * c], (qvec3){0, 0, 0}, states);
}

/* ---- moments ---- */

static void find_moment_rows(const imp_body *body, quat q, const qvec3 axes[3], double sign, double side[3][6])
{
    const qvec3 root = {sqrt(body->inverse_moments.x), sqrt(body->inverse_moments.y), sqrt(body->inverse_moments.z)};
    for (int k = 0; k < 3; k++) {
        const qvec3 own = body->spherical ? axes[k] : quat_rotate_inverse(q, axes[k]);
        const double row[6] = {0, 0, 0, sign * root.x * own.x, sign * root.y * own.y, sign * root.z * own.z};
        for (int l = 0; l < 6; l++) side[k][l] = body->is_static ? 0 : row[l];
    }
}

void imp_cone_find_turns(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts, int count,
                         imp_cone_row *turns)
{
    for (int c = 0; c < count; c++) {
        const imp_cone_contact *own = &contacts[c];
        find_moment_rows(&world->bodies[own->body1], states[own->body1].q, own->axes, 1, turns[c].side[0]);
        find_moment_rows(&world->bodies[own->body2], states[own->body2].q, own->axes, -1, turns[c].side[1]);
    }
}

/* All six rows of one side. */
static void whole_rows(const imp_cone_row *row, const imp_cone_row *turn, int side, double g[6][6])
{
    memcpy(g, row->side[side], 3 * sizeof g[0]);
    memcpy(g[3], turn->side[side], 3 * sizeof g[0]);
}

static void add_whole_block(double a[6][6], double b[6][6], double *w, size_t width)
{
    for (size_t k = 0; k < 6; k++)
        for (size_t l = 0; l < 6; l++)
            for (int m = 0; m < 6; m++) w[k * width + l] += a[k][m] * b[l][m];
}

void imp_cone_assemble_turning(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts,
                               int count, imp_cone_row *rows, imp_cone_row *turns, double *w)
{
    const size_t width = 6 * (size_t)count;
    imp_cone_find_rows(world, states, contacts, count, rows);
    imp_cone_find_turns(world, states, contacts, count, turns);
    memset(w, 0, width * width * sizeof *w);
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) {
            const int one[2] = {contacts[i].body1, contacts[i].body2}, two[2] = {contacts[j].body1, contacts[j].body2};
            for (int s = 0; s < 2; s++)
                for (int t = 0; t < 2; t++) {
                    double a[6][6], b[6][6];
                    if (one[s] != two[t] || world->bodies[one[s]].is_static) continue;
                    whole_rows(&rows[i], &turns[i], s, a);
                    whole_rows(&rows[j], &turns[j], t, b);
                    add_whole_block(a, b, &w[6 * ((size_t)i * width + (size_t)j)], width);
                }
        }
}

void imp_cone_contact_turning(const imp_world *world, const imp_state *states, const imp_cone_contact *contacts,
                              int count, double *u)
{
    for (int c = 0; c < count; c++) {
        const imp_cone_contact *own = &contacts[c];
        const qvec3 w = relative_turning(world, states, own);
        velocities_at(world, states, own, &u[6 * c]);
        for (int k = 0; k < 3; k++) u[6 * c + 3 + k] = qvec3_dot(own->axes[k], w);
    }
}

void imp_cone_push_turning(const imp_world *world, const imp_cone_contact *contacts, int count, const double *r,
                           imp_state *states)
{
    for (int c = 0; c < count; c++)
        push_at(world, &contacts[c], &r[6 * c], sum_along(&contacts[c], &r[6 * c + 3]), states);
}
