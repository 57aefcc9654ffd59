/* SPDX-License-Identifier: MIT
 *
 * An order of the contacts that knows nothing of how bodies are numbered or contacts listed: by hashes of what is known
 * of a contact and of its bodies, refined by those of the bodies' other contacts until what the graph tells apart is
 * told apart (colour refinement, Weisfeiler & Leman 1968). What is still alike then is so by a symmetry of the whole:
 * one of it is marked, and the rest refined again.
 */
#include "contact/encounter.h"

#include <stdlib.h>
#include <string.h>

/* ---- hashes ---- */

/* splitmix64's last step (Steele, Lea, Flood 2014) */
static uint64_t hash(uint64_t key, uint64_t with)
{
    uint64_t z = key + 0x9e3779b97f4a7c15u + (with ^ (with >> 32)) * 0xd6e8feb86659fd93u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static uint64_t hash_number(uint64_t key, double value)
{
    const double plain = value + 0.0; /* -0 is 0 */
    uint64_t bits;
    memcpy(&bits, &plain, sizeof bits);
    return hash(key, bits);
}

static uint64_t hash_vector(uint64_t key, qvec3 v) { return hash_number(hash_number(hash_number(key, v.x), v.y), v.z); }

static uint64_t body_key(const impact_collider *body)
{
    uint64_t key = hash_vector(hash_vector(hash_number(1, body->mass), body->velocity), body->omega);
    if (imp_encounter_is_static(body)) return key;
    const quat q = body->orientation;
    key = hash_vector(key, body->moments);
    return hash_vector(hash_number(key, q.w), (qvec3){q.x, q.y, q.z});
}

static uint64_t meeting_key(const impact_meeting *m)
{
    uint64_t key = hash_vector(hash_vector(hash_vector(2, m->normal), m->offset1), m->offset2);
    key = hash_number(hash_number(hash_number(key, m->friction), m->restitution), m->stiffness);
    return m->pressed ? hash(key, 4) : key;
}

/* ---- refinement ---- */

typedef struct colours {
    const impact_encounter *encounter;
    const int *meeting;
    int count;
    uint64_t *contact, *body, *sum; /* by meeting, by body, by body */
} colours;

static void refine_colours(const colours *c)
{
    const impact_encounter *e = c->encounter;
    for (int i = 0; i < c->count; i++) {
        const impact_meeting *m = &e->meetings[c->meeting[i]];
        uint64_t *key = &c->contact[c->meeting[i]];
        *key = hash(hash(*key, c->body[m->body1]), c->body[m->body2]);
    }
    for (int b = 0; b < e->body_count; b++) c->sum[b] = 0;
    for (int i = 0; i < c->count; i++) {
        const impact_meeting *m = &e->meetings[c->meeting[i]];
        c->sum[m->body1] += hash(c->contact[c->meeting[i]], 1);
        c->sum[m->body2] += hash(c->contact[c->meeting[i]], 2);
    }
    for (int b = 0; b < e->body_count; b++)
        if (!imp_encounter_is_static(&e->bodies[b])) c->body[b] = hash(c->body[b], c->sum[b]);
}

/* The first of two that have one key; -1: none. By insertion: the list is short, or sorted already. */
static int sort_by_key(const colours *c, int *meeting)
{
    for (int i = 1; i < c->count; i++) {
        const int own = meeting[i];
        int j = i;
        for (; j > 0 && c->contact[meeting[j - 1]] > c->contact[own]; j--) meeting[j] = meeting[j - 1];
        meeting[j] = own;
    }
    for (int i = 1; i < c->count; i++)
        if (c->contact[meeting[i]] == c->contact[meeting[i - 1]]) return i - 1;
    return -1;
}

static void sort_canonically(const impact_encounter *encounter, imp_order *order, uint64_t *keys)
{
    const colours c = {encounter,
                       order->meeting,
                       order->count,
                       keys,
                       keys + encounter->meeting_count,
                       keys + encounter->meeting_count + encounter->body_count};
    for (int i = 0; i < c.count; i++)
        c.contact[order->meeting[i]] = meeting_key(&encounter->meetings[order->meeting[i]]);
    for (int b = 0; b < encounter->body_count; b++) c.body[b] = body_key(&encounter->bodies[b]);
    refine_colours(&c);
    int alike = sort_by_key(&c, order->meeting);
    /* a difference travels by one contact a round */
    for (int round = 0; round < c.count && alike >= 0; round++) {
        refine_colours(&c);
        alike = sort_by_key(&c, order->meeting);
    }
    for (int marked = 0; marked < c.count && alike >= 0; marked++) {
        c.contact[order->meeting[alike]] = hash(c.contact[order->meeting[alike]], 3);
        for (int round = 0; round < c.count; round++) refine_colours(&c);
        alike = sort_by_key(&c, order->meeting);
    }
}

/* ---- groups ---- */

static int find_root(int *parents, int b)
{
    while (parents[b] != b) b = parents[b] = parents[parents[b]];
    return b;
}

static void tie_bodies(const impact_encounter *e, const imp_order *order, int *parents)
{
    for (int b = 0; b < e->body_count; b++) parents[b] = b;
    for (int i = 0; i < order->count; i++) {
        const impact_meeting *m = &e->meetings[order->meeting[i]];
        if (imp_encounter_is_static(&e->bodies[m->body1]) || imp_encounter_is_static(&e->bodies[m->body2])) continue;
        parents[find_root(parents, m->body1)] = find_root(parents, m->body2);
    }
}

static int moving_root(const impact_encounter *e, int *parents, int meeting)
{
    const impact_meeting *m = &e->meetings[meeting];
    return find_root(parents, imp_encounter_is_static(&e->bodies[m->body1]) ? m->body2 : m->body1);
}

/* Groups in the order of their first contacts; inside a group the order stays. */
static void part_groups(const impact_encounter *e, imp_order *order, int *parents, int *spare)
{
    int filled = 0;
    for (int i = 0; i < order->count; i++) spare[i] = order->meeting[i];
    for (int i = 0; i < order->count; i++) {
        if (spare[i] < 0) continue;
        const int root = moving_root(e, parents, spare[i]), before = filled;
        for (int j = i; j < order->count; j++) {
            if (spare[j] < 0 || moving_root(e, parents, spare[j]) != root) continue;
            order->group[filled] = order->groups;
            order->meeting[filled++] = spare[j];
            spare[j] = -1;
        }
        order->groups++;
        if (filled - before > order->large) order->large = filled - before;
    }
}

static bool same_vector(qvec3 a, qvec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

static bool same_place(const impact_meeting *a, const impact_meeting *b)
{
    const bool straight = a->body1 == b->body1 && a->body2 == b->body2 && same_vector(a->normal, b->normal) &&
                          same_vector(a->offset1, b->offset1) && same_vector(a->offset2, b->offset2);
    return straight || (a->body1 == b->body2 && a->body2 == b->body1 && same_vector(a->normal, qvec3_neg(b->normal)) &&
                        same_vector(a->offset1, b->offset2) && same_vector(a->offset2, b->offset1));
}

int imp_encounter_same(const impact_encounter *encounter, int meeting)
{
    for (int i = 0; i < meeting; i++)
        if (same_place(&encounter->meetings[i], &encounter->meetings[meeting])) return i;
    return meeting;
}

void imp_encounter_sort(const impact_encounter *encounter, imp_order *order, uint64_t *keys, int *parents)
{
    order->count = order->groups = order->large = 0;
    for (int i = 0; i < encounter->meeting_count; i++) {
        order->merged[i] = imp_encounter_same(encounter, i);
        if (order->merged[i] == i) order->meeting[order->count++] = i;
    }
    sort_canonically(encounter, order, keys);
    tie_bodies(encounter, order, parents);
    part_groups(encounter, order, parents, parents + encounter->body_count);
}
