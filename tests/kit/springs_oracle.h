/* SPDX-License-Identifier: MIT
 *
 * The springs of docs/together.md integrated plainly, in 80 bits and in the bodies' own velocities: extrapolated
 * midpoint steps (Gragg, Bulirsch, Stoer), events by halving the step until it is nothing. Slow, and shares no code
 * with the library. Slip that begins by and by is followed in a plane only.
 */
#ifndef SPRINGS_ORACLE_H
#define SPRINGS_ORACLE_H

#include <math.h>
#include <stdbool.h>
#include <string.h>
#include <impact/together.h>
#include <quat/rotation.h>

enum {
    ORACLE_BODIES = 13,
    ORACLE_CONTACTS = 12,
    ORACLE_STATE = 6 * ORACLE_BODIES + ORACLE_CONTACTS,
    ORACLE_COLUMNS = 8
};

typedef long double real;

typedef struct oracle_contact {
    int body[2];
    real row[3][2][6]; /* velocity of the point along n, t1, t2 by the bodies' velocities */
    real friction, restitution, stiffness, base, kappa, deepest;
    enum { ORACLE_OPEN, ORACLE_LOADS, ORACLE_UNLOADS } normal;
    enum { ORACLE_SMOOTH, ORACLE_STICKS, ORACLE_SLIPS } slip;
    real along[2]; /* of the last slip there was */
    real force[3];
} oracle_contact;

typedef struct oracle {
    int bodies, contacts;
    real exponent;
    real inverse[ORACLE_BODIES][6][6];
    oracle_contact contact[ORACLE_CONTACTS];
    real y[ORACLE_STATE]; /* velocities, then indentations */
    bool turning;         /* a slip began by and by out of a plane: not followed */
} oracle;

static inline void oracle_cross(const real *a, const real *b, real *c)
{
    c[0] = a[1] * b[2] - a[2] * b[1], c[1] = a[2] * b[0] - a[0] * b[2], c[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void oracle_set_body(oracle *o, int b, const impact_collider *body)
{
    const double start[6] = {body->velocity.x, body->velocity.y, body->velocity.z,
                             body->omega.x,    body->omega.y,    body->omega.z};
    memset(o->inverse[b], 0, sizeof o->inverse[b]);
    for (int k = 0; k < 6; k++) o->y[6 * b + k] = start[k];
    if (isinf(body->mass)) return;
    const real w = body->orientation.w, x = body->orientation.x, y = body->orientation.y, z = body->orientation.z;
    const real r[3][3] = {{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
                          {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
                          {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
    const real j[3] = {body->moments.x, body->moments.y, body->moments.z};
    for (int i = 0; i < 3; i++) {
        o->inverse[b][i][i] = 1 / (real)body->mass;
        for (int k = 0; k < 3; k++)
            for (int l = 0; l < 3; l++) o->inverse[b][3 + i][3 + k] += r[i][l] * r[k][l] / j[l];
    }
}

static inline void oracle_set_contact(oracle_contact *c, const impact_meeting *m)
{
    real axes[3][3] = {{m->normal.x, m->normal.y, m->normal.z}};
    const real size = sqrtl(axes[0][0] * axes[0][0] + axes[0][1] * axes[0][1] + axes[0][2] * axes[0][2]);
    for (int k = 0; k < 3; k++) axes[0][k] /= size;
    const real other[3] = {0, fabsl(axes[0][2]) > 0.5L ? 1 : 0, fabsl(axes[0][2]) > 0.5L ? 0 : 1};
    oracle_cross(axes[0], other, axes[1]);
    const real across = sqrtl(axes[1][0] * axes[1][0] + axes[1][1] * axes[1][1] + axes[1][2] * axes[1][2]);
    for (int k = 0; k < 3; k++) axes[1][k] /= across;
    oracle_cross(axes[0], axes[1], axes[2]);
    const real arms[2][3] = {{m->offset1.x, m->offset1.y, m->offset1.z}, {m->offset2.x, m->offset2.y, m->offset2.z}};
    *c = (oracle_contact){.body = {m->body1, m->body2},
                          .friction = m->friction,
                          .restitution = m->restitution,
                          .stiffness = m->stiffness};
    for (int i = 0; i < 3; i++)
        for (int s = 0; s < 2; s++) {
            real torque[3];
            oracle_cross(arms[s], axes[i], torque);
            for (int k = 0; k < 3; k++) {
                c->row[i][s][k] = s == 0 ? axes[i][k] : -axes[i][k];
                c->row[i][s][3 + k] = s == 0 ? torque[k] : -torque[k];
            }
        }
}

static inline real oracle_velocity(const oracle *o, const real *y, int c, int i)
{
    const oracle_contact *own = &o->contact[c];
    real sum = 0;
    for (int s = 0; s < 2; s++)
        for (int k = 0; k < 6; k++) sum += own->row[i][s][k] * y[6 * own->body[s] + k];
    return sum;
}

/* rate[6 bodies] += M^-1 G^T of a force along axis i of contact c. */
static inline void oracle_push(const oracle *o, int c, int i, real force, real *rate)
{
    const oracle_contact *own = &o->contact[c];
    for (int s = 0; s < 2; s++)
        for (int a = 0; a < 6; a++)
            for (int b = 0; b < 6; b++)
                rate[6 * own->body[s] + a] += o->inverse[own->body[s]][a][b] * own->row[i][s][b] * force;
}

static inline bool oracle_presses(const oracle_contact *c) { return c->normal != ORACLE_OPEN; }

/* Friction of what sticks: the sweep's equations u_t' = 0, by Gauss and full pivoting, what is dependent left out. */
static inline void oracle_hold(const oracle *o, real *rate, real friction[][2])
{
    int n = 0, which[2 * ORACLE_CONTACTS];
    real a[2 * ORACLE_CONTACTS][2 * ORACLE_CONTACTS + 1], most = 0;
    for (int c = 0; c < o->contacts; c++)
        if (oracle_presses(&o->contact[c]) && o->contact[c].slip == ORACLE_STICKS)
            for (int i = 1; i < 3; i++) which[n++] = 3 * c + i;
    for (int k = 0; k < n; k++) {
        real unit[6 * ORACLE_BODIES] = {0};
        oracle_push(o, which[k] / 3, which[k] % 3, 1, unit);
        for (int l = 0; l < n; l++) a[l][k] = oracle_velocity(o, unit, which[l] / 3, which[l] % 3);
        a[k][n] = -oracle_velocity(o, rate, which[k] / 3, which[k] % 3);
        most = fmaxl(most, a[k][k]);
    }
    bool used[2 * ORACLE_CONTACTS] = {false};
    for (int step = 0; step < n; step++) { /* symmetric: pivots on the diagonal */
        int best = -1;
        for (int k = 0; k < n; k++)
            if (!used[k] && (best < 0 || a[k][k] > a[best][best])) best = k;
        if (a[best][best] < 1e-14L * most) break;
        used[best] = true;
        for (int k = 0; k < n; k++) {
            if (k == best) continue;
            const real part = a[k][best] / a[best][best];
            for (int l = 0; l <= n; l++) a[k][l] -= part * a[best][l];
        }
    }
    for (int k = 0; k < n; k++) {
        const real f = used[k] ? a[k][n] / a[k][k] : 0;
        friction[which[k] / 3][which[k] % 3 - 1] = f;
        oracle_push(o, which[k] / 3, which[k] % 3, f, rate);
    }
}

static inline void oracle_rate(oracle *o, const real *y, real *rate)
{
    const int first = 6 * o->bodies;
    real friction[ORACLE_CONTACTS][2] = {{0}};
    memset(rate, 0, (size_t)(first + o->contacts) * sizeof *rate);
    for (int c = 0; c < o->contacts; c++) {
        oracle_contact *own = &o->contact[c];
        const real x = y[first + c] - own->base;
        own->force[0] = oracle_presses(own) && x > 0 ? own->kappa * powl(x, o->exponent) : 0;
        oracle_push(o, c, 0, own->force[0], rate);
        if (!oracle_presses(own) || own->slip != ORACLE_SLIPS) continue;
        real u[2] = {oracle_velocity(o, y, c, 1), oracle_velocity(o, y, c, 2)};
        const real speed = hypotl(u[0], u[1]);
        const bool goes = speed > 1e-17L && u[0] * own->along[0] + u[1] * own->along[1] > 0; /* not past its stop */
        for (int i = 0; i < 2; i++) {
            friction[c][i] = -own->friction * own->force[0] * (goes ? u[i] / speed : own->along[i]);
            oracle_push(o, c, 1 + i, friction[c][i], rate);
        }
    }
    oracle_hold(o, rate, friction);
    for (int c = 0; c < o->contacts; c++) {
        for (int i = 0; i < 2; i++) o->contact[c].force[1 + i] = friction[c][i];
        rate[first + c] = -oracle_velocity(o, y, c, 0);
    }
}

/* One extrapolated step; the error over the largest there is. */
static inline real oracle_step(oracle *o, const real *from, real h, real *to)
{
    static const int parts[ORACLE_COLUMNS] = {2, 4, 6, 8, 10, 12, 14, 16};
    const int n = 6 * o->bodies + o->contacts;
    real table[ORACLE_COLUMNS][ORACLE_STATE], start[ORACLE_STATE], rate[ORACLE_STATE], error = 0;
    oracle_rate(o, from, start);
    for (int j = 0; j < ORACLE_COLUMNS; j++) {
        real a[ORACLE_STATE], b[ORACLE_STATE], part = h / parts[j];
        for (int i = 0; i < n; i++) a[i] = from[i], b[i] = from[i] + part * start[i];
        for (int k = 1; k < parts[j]; k++) {
            oracle_rate(o, b, rate);
            for (int i = 0; i < n; i++) {
                const real next = a[i] + 2 * part * rate[i];
                a[i] = b[i], b[i] = next;
            }
        }
        for (int i = 0; i < n; i++) table[j][i] = b[i];
        for (int k = j - 1; k >= 0; k--) {
            const real ratio = (real)parts[j] / parts[k];
            for (int i = 0; i < n; i++)
                table[k][i] = table[k + 1][i] + (table[k + 1][i] - table[k][i]) / (ratio * ratio - 1);
        }
        if (j == ORACLE_COLUMNS - 1) break;
        if (j == ORACLE_COLUMNS - 2) memcpy(to, table[0], (size_t)n * sizeof *to);
    }
    real size = 1e-3L;
    for (int i = 0; i < n; i++) {
        error = fmaxl(error, fabsl(table[0][i] - to[i]));
        size = fmaxl(size, fabsl(to[i] = table[0][i]));
    }
    return error / size;
}

/* What is no longer so at y: 1 turn, 2 loaded on, 3 open, 4 close, 5 stop, 6 gives way; 0: nothing. */
static inline int oracle_event(const oracle *o, const real *y, int c)
{
    const oracle_contact *own = &o->contact[c];
    const real x = y[6 * o->bodies + c] - own->base, approach = -oracle_velocity(o, y, c, 0);
    if (own->normal == ORACLE_OPEN) return x >= 0 && approach > 1e-17L ? 4 : 0;
    if (own->normal == ORACLE_LOADS && own->restitution < 1 && approach < 0) return 1;
    if (own->normal == ORACLE_UNLOADS && y[6 * o->bodies + c] > own->deepest * (1 + 1e-18L) && approach > 0) return 2;
    if (x <= 0 && approach < 0) return 3;
    if (own->slip == ORACLE_SLIPS) {
        const real along = own->along[0] * oracle_velocity(o, y, c, 1) + own->along[1] * oracle_velocity(o, y, c, 2);
        if (along < -1e-16L) return 5;
    }
    if (own->slip == ORACLE_STICKS &&
        hypotl(own->force[1], own->force[2]) > own->friction * own->force[0] * (1 + 1e-16L))
        return 6;
    return 0;
}

/* Friction of all that is still, u_t = 0: the least u_t' within the discs, by projected steps. */
static inline void oracle_choose(oracle *o)
{
    real f[ORACLE_CONTACTS][2] = {{0}}, rate[ORACLE_STATE];
    bool still[ORACLE_CONTACTS];
    for (int c = 0; c < o->contacts; c++) {
        oracle_contact *own = &o->contact[c];
        still[c] = oracle_presses(own) && own->friction > 0 &&
                   hypotl(oracle_velocity(o, o->y, c, 1), oracle_velocity(o, o->y, c, 2)) < 1e-15L;
        if (still[c]) own->slip = ORACLE_STICKS;
    }
    oracle_rate(o, o->y, rate);
    bool holds = true;
    for (int c = 0; c < o->contacts; c++)
        holds = holds && (!still[c] || hypotl(o->contact[c].force[1], o->contact[c].force[2]) <=
                                           o->contact[c].friction * o->contact[c].force[0]);
    if (holds) return;
    for (int c = 0; c < o->contacts; c++)
        if (still[c]) o->contact[c].slip = ORACLE_SMOOTH; /* set apart while they are looked for */
    real base[ORACLE_STATE], size[ORACLE_CONTACTS] = {0};
    oracle_rate(o, o->y, base);
    for (int c = 0; c < o->contacts; c++)
        for (int d = 0; d < o->contacts; d++)
            for (int i = 1; i < 3; i++)
                for (int j = 1; j < 3; j++) {
                    real unit[6 * ORACLE_BODIES] = {0};
                    oracle_push(o, d, j, 1, unit);
                    if (still[c] && still[d]) size[c] += fabsl(oracle_velocity(o, unit, c, i));
                }
    for (int sweep = 0; sweep < 20000; sweep++)
        for (int c = 0; c < o->contacts; c++) {
            if (!still[c]) continue;
            const real bound = o->contact[c].friction * o->contact[c].force[0], before[2] = {f[c][0], f[c][1]};
            for (int i = 0; i < 2; i++) f[c][i] -= oracle_velocity(o, base, c, 1 + i) / size[c];
            const real now = hypotl(f[c][0], f[c][1]);
            for (int i = 0; i < 2; i++) {
                if (now > bound) f[c][i] *= bound / now;
                oracle_push(o, c, 1 + i, f[c][i] - before[i], base);
            }
        }
    for (int c = 0; c < o->contacts; c++) {
        if (!still[c]) continue;
        const real a[2] = {oracle_velocity(o, base, c, 1), oracle_velocity(o, base, c, 2)}, speed = hypotl(a[0], a[1]);
        o->contact[c].slip = speed > 1e-13L ? ORACLE_SLIPS : ORACLE_STICKS;
        for (int i = 0; i < 2 && speed > 1e-13L; i++) o->contact[c].along[i] = a[i] / speed;
    }
}

/* Where contact c slips to, if it does. */
static inline void oracle_look(oracle *o, int c)
{
    const real u[2] = {oracle_velocity(o, o->y, c, 1), oracle_velocity(o, o->y, c, 2)}, speed = hypotl(u[0], u[1]);
    for (int i = 0; i < 2 && speed > 1e-15L; i++) o->contact[c].along[i] = u[i] / speed;
}

static inline void oracle_change(oracle *o, int c, int event, bool planar)
{
    oracle_contact *own = &o->contact[c];
    const int first = 6 * o->bodies;
    const real stiff = own->stiffness * powl(own->restitution, -2 * o->exponent), depth = o->y[first + c];
    switch (event) {
    case 1:
        own->normal = ORACLE_UNLOADS, own->deepest = depth, own->kappa = stiff;
        own->base = (1 - own->restitution * own->restitution) * depth;
        break;
    case 2: own->normal = ORACLE_LOADS, own->base = 0, own->kappa = own->stiffness; break;
    case 3: own->normal = ORACLE_OPEN; break;
    case 4:
        own->normal = own->deepest > 0 ? ORACLE_UNLOADS : ORACLE_LOADS;
        own->kappa = own->deepest > 0 ? stiff : own->stiffness;
        own->slip = own->friction > 0 ? ORACLE_SLIPS : ORACLE_SMOOTH;
        o->y[first + c] += 1e-24L; /* so that forces tell what slips */
        oracle_look(o, c);
        oracle_choose(o);
        break;
    case 5: oracle_choose(o); break;
    case 6: {
        const real size = hypotl(own->force[1], own->force[2]);
        own->slip = ORACLE_SLIPS;
        for (int i = 0; i < 2; i++) own->along[i] = -own->force[1 + i] / size;
        o->turning = o->turning || !planar;
        break;
    }
    default: break;
    }
}

static inline int oracle_first_event(oracle *o, const real *y, int *contact)
{
    real rate[ORACLE_STATE];
    oracle_rate(o, y, rate);
    for (*contact = 0; *contact < o->contacts; ++*contact) {
        const int event = oracle_event(o, y, *contact);
        if (event) return event;
    }
    return 0;
}

/* Integrates the encounter; false where it is one that the oracle does not follow, or takes too long. */
static inline bool oracle_run(oracle *o, const impact_encounter *e, double exponent, bool planar)
{
    memset(o, 0, sizeof *o);
    o->bodies = e->body_count, o->contacts = e->meeting_count, o->exponent = exponent;
    for (int b = 0; b < o->bodies; b++) oracle_set_body(o, b, &e->bodies[b]);
    for (int c = 0; c < o->contacts; c++) oracle_set_contact(&o->contact[c], &e->meetings[c]);
    real h = 1e-3L, to[ORACLE_STATE];
    for (int step = 0; step < 3000 && !o->turning; step++) {
        int contact;
        const int event = oracle_first_event(o, o->y, &contact);
        if (event) {
            oracle_change(o, contact, event, planar);
            continue;
        }
        bool over = true;
        for (int c = 0; c < o->contacts; c++)
            over = over && !oracle_presses(&o->contact[c]) && oracle_velocity(o, o->y, c, 0) > -1e-16L;
        if (over) return true;
        real error = oracle_step(o, o->y, h, to);
        for (; error > 1e-15L && h > 1e-17L; error = oracle_step(o, o->y, h, to)) h /= 2;
        if (oracle_first_event(o, to, &contact)) { /* to just behind the first one */
            real low = 0, high = h;
            for (int k = 0; k < 70 && high - low > 1e-19L; k++) {
                const real middle = (low + high) / 2;
                oracle_step(o, o->y, middle, to);
                *(oracle_first_event(o, to, &contact) ? &high : &low) = middle;
            }
            oracle_step(o, o->y, high, to);
        } else if (error < 1e-16L) {
            h *= 2;
        }
        memcpy(o->y, to, sizeof to);
        for (int c = 0; c < o->contacts; c++)
            if (o->contact[c].slip == ORACLE_SLIPS && !oracle_event(o, o->y, c)) oracle_look(o, c);
    }
    return false;
}

#endif
