/* SPDX-License-Identifier: MIT */
#include "scene/tracks.h"
#include "world/world_gap.h"

#include <float.h>
#include <impact/flight.h>

enum { FEW_NEAR = 2, MANY_NEAR = 8 }; /* least instructions in a gas of balls, a tenth filled (./run bench crowd) */

/* fmin and fmax of what is no NaN: those are calls. */
static double smaller(double a, double b) { return a < b ? a : b; }
static double larger(double a, double b) { return a > b ? a : b; }

/* ---- memory ---- */

impact_status imp_tracks_open(imp_tracks *tracks, imp_world *world, imp_queue *queue)
{
    const int n = world->body_count;
    *tracks = (imp_tracks){.world = world,
                           .queue = queue,
                           .first_slot = queue->slots,
                           .near_free = -1,
                           .tracks = imp_arena_take(world->arena, (size_t)n, sizeof *tracks->tracks),
                           .paired_with = imp_arena_take(world->arena, (size_t)n, sizeof *tracks->paired_with),
                           .planes = imp_arena_take(world->arena, (size_t)n, sizeof *tracks->planes)};
    if (!tracks->tracks || !tracks->paired_with || !tracks->planes) return IMPACT_ENOMEM;
    for (int i = 0; i < n; i++) {
        const imp_body *body = &world->bodies[i];
        imp_track *track = &tracks->tracks[i];
        *track = (imp_track){.leave = INFINITY,
                             .meet = INFINITY,
                             .first_near = -1,
                             .island = -1,
                             .last_event = -INFINITY,
                             .fatness = IMP_BOX_FIRST};
        tracks->paired_with[i] = -1;
        if (body->shape.kind == IMPACT_PLANE) tracks->planes[tracks->plane_count++].body = i;
        const bool tumbles = !body->is_static && !body->spherical;
        if (tumbles) track->tumble = imp_arena_take(world->arena, 1, sizeof *track->tumble);
        if (tumbles && !track->tumble) return IMPACT_ENOMEM;
        if (imp_queue_add(queue) < 0) return IMPACT_ENOMEM;
    }
    return imp_grid_open(&tracks->grid, world->arena, n);
}

/* ---- pairs ---- */

static bool list_near(imp_arena *arena, imp_track *track, imp_companion near, int *place)
{
    if (track->companion_count == track->companion_room) {
        imp_companion *list =
            imp_arena_grow(arena, track->companions, &track->companion_room, track->companion_count + 1, sizeof *list);
        if (!list) return false;
        track->companions = list;
    }
    *place = track->companion_count;
    track->companions[track->companion_count++] = near;
    return true;
}

static int new_near(imp_tracks *tracks)
{
    int near = tracks->near_free;
    if (near >= 0) {
        tracks->near_free = tracks->near[near].place[0];
        return near;
    }
    imp_near *more =
        imp_arena_grow(tracks->world->arena, tracks->near, &tracks->near_room, tracks->near_count + 1, sizeof *more);
    if (!more) return -1;
    tracks->near = more;
    return tracks->near_count++;
}

static void leave_list(imp_tracks *tracks, int near, int k)
{
    imp_track *track = &tracks->tracks[tracks->near[near].body[k]];
    const int place = tracks->near[near].place[k];
    const imp_companion last = track->companions[--track->companion_count];
    track->companions[place] = last;
    imp_near *moved = &tracks->near[last.near];
    moved->place[moved->body[0] != tracks->near[near].body[k]] = place;
}

static void set_slot(imp_tracks *tracks, int body)
{
    const imp_track *track = &tracks->tracks[body];
    imp_queue_set(tracks->queue, tracks->first_slot + body, smaller(track->leave, track->meet));
}

/* The first of its pairs' times; of several the pair's that was made first. */
static void find_first(const imp_tracks *tracks, imp_track *track)
{
    track->meet = INFINITY;
    track->first_near = -1;
    for (int k = 0; k < track->companion_count; k++) {
        const double t = tracks->near[track->companions[k].near].t;
        if (t < track->meet) track->meet = t, track->first_near = track->companions[k].near;
    }
}

static void drop_near(imp_tracks *tracks, int near)
{
    const int body[2] = {tracks->near[near].body[0], tracks->near[near].body[1]};
    for (int k = 0; k < 2; k++) tracks->paired_with[body[k]] = -1;
    for (int k = 0; k < 2; k++) leave_list(tracks, near, k);
    for (int k = 0; k < 2; k++) {
        imp_track *track = &tracks->tracks[body[k]];
        if (track->first_near != near) continue;
        find_first(tracks, track);
        set_slot(tracks, body[k]);
    }
    tracks->near[near].place[0] = tracks->near_free;
    tracks->near_free = near;
}

/* Told a new time of one of its pairs; whether its own changes. A static body's pairs' other bodies know. */
static bool hear(imp_tracks *tracks, int body, int near)
{
    imp_track *track = &tracks->tracks[body];
    const double t = tracks->near[near].t;
    if (t <= track->meet) {
        if (tracks->world->bodies[body].is_static) return false;
        track->meet = t;
        track->first_near = t < INFINITY ? near : -1;
        return true;
    }
    if (track->first_near != near) return false;
    find_first(tracks, track);
    return true;
}

static void tell(imp_tracks *tracks, int near)
{
    for (int k = 0; k < 2; k++)
        if (hear(tracks, tracks->near[near].body[k], near)) set_slot(tracks, tracks->near[near].body[k]);
}

static bool stands(const imp_tracks *tracks, int body) { return tracks->tracks[body].segment.kind == IMP_SEGMENT_REST; }

/* From where both segments begin, or the search stopped, up to where a body leaves its box. */
static void search(imp_tracks *tracks, imp_near *near, double from)
{
    const int i = near->body[0], j = near->body[1];
    if (near->held || (stands(tracks, i) && stands(tracks, j))) {
        near->t = INFINITY, near->touches = false;
        return;
    }
    const imp_track *a = &tracks->tracks[i], *b = &tracks->tracks[j];
    const imp_search s = {.body = {&tracks->world->bodies[i], &tracks->world->bodies[j]},
                          .segment = {&a->segment, &b->segment},
                          .beyond = near->beyond,
                          .still = tracks->world->slip_speed,
                          .gaps = tracks->world->gaps,
                          .usage = &tracks->world->usage,
                          .axis = &near->axis};
    const imp_found found = imp_search_contact(&s, from, smaller(a->leave, b->leave));
    near->t = found.t, near->touches = found.touches;
}

/* The pair's next contact, from t on; false: there is none, as there was none. */
static bool predict(imp_tracks *tracks, imp_near *near, double t)
{
    const double before = near->t;
    const double t0 = tracks->tracks[near->body[0]].segment.t0, t1 = tracks->tracks[near->body[1]].segment.t0;
    search(tracks, near, larger(t0, t1));
    if (near->t < t) near->t = t; /* what began as an overlap by a rounding is met now */
    return near->t < INFINITY || before < INFINITY;
}

void imp_tracks_predict(imp_tracks *tracks, int near, double t)
{
    if (predict(tracks, &tracks->near[near], t)) tell(tracks, near);
}

/* Which of them stands first: what moves before what is static, a plane last; else as the definition has them. */
static void name_bodies(const imp_tracks *tracks, int i, int j, imp_near *near)
{
    const int low = i < j ? i : j, high = i < j ? j : i;
    const bool swap = tracks->world->bodies[low].is_static;
    near->body[0] = swap ? high : low;
    near->body[1] = swap ? low : high;
}

/* Behind the plane from the start, beside its bounds. */
static bool is_beyond(imp_tracks *tracks, const imp_near *near, double t)
{
    imp_state state[2];
    const imp_body *b1 = &tracks->world->bodies[near->body[0]], *b2 = &tracks->world->bodies[near->body[1]];
    if (b2->shape.kind != IMPACT_PLANE || (!isfinite(b2->shape.a) && !isfinite(b2->shape.b))) return false;
    state[0] = imp_segment_at(&tracks->tracks[near->body[0]].segment, b1, t);
    state[1] = tracks->tracks[near->body[1]].segment.start;
    impact_contact contact;
    imp_gap_of(b1, &state[0], b2, &state[1], tracks->world->gaps, &tracks->world->usage, &contact);
    const qvec3 local = quat_rotate_inverse(state[1].q, contact.offset2);
    return contact.gap < 0 && (fabs(local.x) > b2->shape.a || fabs(local.y) > b2->shape.b);
}

static impact_status make_near(imp_tracks *tracks, int i, int j, double t)
{
    const int n = new_near(tracks);
    if (n < 0) return IMPACT_ENOMEM;
    imp_near *near = &tracks->near[n];
    *near = (imp_near){.t = INFINITY};
    name_bodies(tracks, i, j, near);
    for (int k = 0; k < 2; k++)
        if (!list_near(tracks->world->arena, &tracks->tracks[near->body[k]], (imp_companion){n, near->body[1 - k]},
                       &near->place[k]))
            return IMPACT_ENOMEM;
    near->beyond = is_beyond(tracks, near, t);
    imp_tracks_predict(tracks, n, t);
    return IMPACT_OK;
}

/* ---- boxes ---- */

static void store(qvec3 v, double out[3]) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

static double rounding(qvec3 x) { return 64 * DBL_EPSILON * (fabs(x.x) + fabs(x.y) + fabs(x.z)); }

/* Lowest and highest of a + b t + c t^2/2 over [0, T]. */
static void range(double a, double b, double c, double T, double *low, double *high)
{
    const double end = a + T * (b + 0.5 * T * c), turn = -b / c;
    *low = smaller(a, end), *high = larger(a, end);
    if (!(turn > 0 && turn < T)) return;
    const double there = a + 0.5 * turn * b;
    *low = smaller(*low, there), *high = larger(*high, there);
}

static imp_box static_box(const imp_body *body, const imp_state *state)
{
    const impact_solid solid = imp_solid_of(body, state);
    imp_box box;
    double x[3];
    store(solid.position, x);
    for (int i = 0; i < 3; i++) {
        const qvec3 axis = {i == 0, i == 1, i == 2}, d = quat_rotate_inverse(solid.orientation, axis);
        box.low[i] = x[i] - impact_shape_support(&solid.shape, qvec3_neg(d), NULL) - rounding(solid.position);
        box.high[i] = x[i] + impact_shape_support(&solid.shape, d, NULL) + rounding(solid.position);
    }
    return box;
}

/* Of its centre: damping of its turning alone does not bend that. */
static bool is_parabola(const imp_segment *s, const imp_body *body)
{
    return s->kind == IMP_SEGMENT_FREE || s->kind == IMP_SEGMENT_ROLL ||
           (s->kind == IMP_SEGMENT_DAMPED && !(body->linear_rate > 0));
}

/* How long the body is to stay in a box: until it has gone the fatness times its radius, at its speed or from rest. */
static double time_in_box(const imp_track *track, const imp_body *body, qvec3 v, double t)
{
    const double way = track->fatness * body->radius, speed = qvec3_norm(v),
                 pull = qvec3_norm(track->segment.acceleration);
    double time = way / (speed + sqrt(pull * way));
    if (!isfinite(time)) time = 0; /* it stands */
    return larger(time, IMP_BOX_SHORTEST * fabs(t));
}

/* From t on. */
static double top_speed(const imp_segment *s, const imp_body *body, double t)
{
    return imp_segment_bounds(s, body, t, s->t1 - t).speed;
}

static imp_box fat_box(const imp_track *track, const imp_body *body, double t)
{
    const imp_segment *s = &track->segment;
    qvec3 velocity;
    const qvec3 place = imp_segment_place(s, body, t, &velocity);
    const double around = body->radius * (1 + IMP_BOX_MARGIN * track->fatness) + rounding(place);
    double time = time_in_box(track, body, velocity, t), x[3], v[3], a[3] = {0, 0, 0};
    if (s->kind == IMP_SEGMENT_DENSE) time = larger(time, s->t1 - t);
    store(place, x), store(velocity, v);
    if (is_parabola(s, body)) store(s->acceleration, a);
    const double top = is_parabola(s, body) || s->kind == IMP_SEGMENT_REST ? 0 : top_speed(s, body, t);
    imp_box box;
    for (int k = 0; k < 3; k++) {
        if (is_parabola(s, body))
            range(x[k], v[k], a[k], time, &box.low[k], &box.high[k]);
        else
            box.low[k] = x[k] - time * top, box.high[k] = x[k] + time * top;
        box.low[k] -= around, box.high[k] += around;
    }
    return box;
}

/* When the body's ball first reaches out of the box, from t on; what is no parabola, at its greatest speed. */
static double leave_time(const imp_track *track, const imp_body *body, const imp_box *box, double t)
{
    const imp_segment *s = &track->segment;
    if (s->kind == IMP_SEGMENT_REST) return INFINITY;
    qvec3 velocity;
    double x[3], v[3], a[3] = {0, 0, 0}, time = INFINITY, room = INFINITY;
    store(imp_segment_place(s, body, t, &velocity), x);
    store(velocity, v);
    if (is_parabola(s, body)) store(s->acceleration, a);
    for (int k = 0; k < 3; k++) {
        const double up = box->high[k] - body->radius - x[k], down = x[k] - box->low[k] - body->radius;
        room = smaller(room, smaller(up, down));
        if (!(up > 0 && down > 0)) return t;
        if (!is_parabola(s, body)) continue;
        if (v[k] > 0 || a[k] > 0) time = smaller(time, impact_flight_fall_time(up, -v[k], -a[k]));
        if (v[k] < 0 || a[k] < 0) time = smaller(time, impact_flight_fall_time(down, v[k], a[k]));
    }
    if (!is_parabola(s, body)) time = room / top_speed(s, body, t);
    return t + time;
}

static void place_plane(imp_wide *plane, const imp_state *state)
{
    store(quat_rotate(state->q, (qvec3){0, 0, 1}), plane->n);
    plane->d = plane->n[0] * state->x.x + plane->n[1] * state->x.y + plane->n[2] * state->x.z;
}

/* Whether the box reaches over the plane, or to where rounding might have it. */
static bool box_meets_plane(const imp_box *box, const imp_wide *plane)
{
    double low = -plane->d, size = fabs(plane->d);
    for (int k = 0; k < 3; k++) {
        const double x = plane->n[k] > 0 ? box->low[k] : box->high[k];
        low += plane->n[k] * x;
        size += fabs(plane->n[k] * x);
    }
    return low <= 8 * DBL_EPSILON * size;
}

/* What is in no grid is a plane. */
static bool boxes_meet(const imp_tracks *tracks, int other, const imp_box *box)
{
    if (tracks->grid.entries[other].level >= 0) return imp_boxes_overlap(box, &tracks->grid.entries[other].box);
    int k = 0;
    while (tracks->planes[k].body != other) k++;
    return box_meets_plane(box, &tracks->planes[k]);
}

int imp_tracks_find(const imp_tracks *tracks, int i, int j)
{
    const imp_track *a = &tracks->tracks[i], *b = &tracks->tracks[j];
    const bool shorter = a->companion_count <= b->companion_count;
    const imp_track *list = shorter ? a : b;
    for (int k = 0; k < list->companion_count; k++)
        if (list->companions[k].other == (shorter ? j : i)) return list->companions[k].near;
    return -1;
}

/* Pairs with all whose boxes overlap the body's, and with no other. */
static impact_status renew_pairs(imp_tracks *tracks, int body, double t)
{
    imp_track *track = &tracks->tracks[body];
    const imp_box box = tracks->grid.entries[body].box;
    const bool is_static = tracks->world->bodies[body].is_static;
    for (int k = track->companion_count - 1; k >= 0; k--) {
        const int other = track->companions[k].other;
        tracks->paired_with[other] = body;
        if (boxes_meet(tracks, other, &box)) continue;
        drop_near(tracks, track->companions[k].near);
    }
    impact_status status = imp_grid_query(&tracks->grid, &box);
    for (int k = 0; status == IMPACT_OK && k < tracks->grid.found_count; k++) {
        const int other = tracks->grid.found[k];
        if (other == body || (is_static && tracks->world->bodies[other].is_static)) continue;
        if (tracks->paired_with[other] != body) status = make_near(tracks, body, other, t);
    }
    for (int k = 0; status == IMPACT_OK && !is_static && k < tracks->plane_count; k++) {
        const imp_wide *plane = &tracks->planes[k];
        if (tracks->paired_with[plane->body] != body && box_meets_plane(&box, plane))
            status = make_near(tracks, body, plane->body, t);
    }
    return status;
}

static void put_slot(imp_tracks *tracks, int body, double t)
{
    imp_track *track = &tracks->tracks[body];
    track->leave = leave_time(track, &tracks->world->bodies[body], &tracks->grid.entries[body].box, t);
    if (track->segment.kind == IMP_SEGMENT_DENSE && track->leave >= track->segment.t1) track->leave = INFINITY;
    set_slot(tracks, body);
}

static impact_status renew_box(imp_tracks *tracks, int body, double t)
{
    imp_track *track = &tracks->tracks[body];
    if (track->companion_count < FEW_NEAR) track->fatness = smaller(1.5 * track->fatness, IMP_BOX_FATTEST);
    if (track->companion_count > MANY_NEAR) track->fatness = larger(0.8 * track->fatness, IMP_BOX_LEAST);
    const imp_box box = fat_box(track, &tracks->world->bodies[body], t);
    impact_status status = imp_grid_put(&tracks->grid, body, &box);
    put_slot(tracks, body, t);
    return status == IMPACT_OK ? renew_pairs(tracks, body, t) : status;
}

/* ---- following ---- */

void imp_tracks_clear(imp_tracks *tracks)
{
    imp_grid_clear(&tracks->grid);
    tracks->near_count = 0, tracks->near_free = -1;
    for (int i = 0; i < tracks->world->body_count; i++) {
        imp_track *track = &tracks->tracks[i];
        track->companion_count = 0;
        track->leave = track->meet = INFINITY;
        track->first_near = track->island = tracks->paired_with[i] = -1;
        track->fatness = IMP_BOX_FIRST;
    }
}

impact_status imp_tracks_renew(imp_tracks *tracks, double t)
{
    const imp_world *world = tracks->world;
    impact_status status = IMPACT_OK;
    for (int i = 0; status == IMPACT_OK && i < world->body_count; i++) {
        if (world->bodies[i].shape.kind == IMPACT_PLANE) continue;
        const imp_box box = world->bodies[i].is_static ? static_box(&world->bodies[i], &tracks->tracks[i].segment.start)
                                                       : fat_box(&tracks->tracks[i], &world->bodies[i], t);
        status = imp_grid_put(&tracks->grid, i, &box);
        put_slot(tracks, i, t);
    }
    for (int i = 0; status == IMPACT_OK && i < world->body_count; i++)
        if (!world->bodies[i].is_static) status = renew_pairs(tracks, i, t);
    return status;
}

impact_status imp_tracks_begin(imp_tracks *tracks, double t, const imp_state *states)
{
    const imp_world *world = tracks->world;
    for (int i = 0; i < world->body_count; i++)
        tracks->tracks[i].segment =
            imp_segment_fly(&world->bodies[i], t, &states[i], world->gravity, tracks->tracks[i].tumble);
    for (int k = 0; k < tracks->plane_count; k++) place_plane(&tracks->planes[k], &states[tracks->planes[k].body]);
    return imp_tracks_renew(tracks, t);
}

impact_status imp_tracks_follow(imp_tracks *tracks, int body, const imp_segment *segment, double t)
{
    tracks->tracks[body].segment = *segment;
    tracks->tracks[body].told = false;
    put_slot(tracks, body, t);
    if (tracks->tracks[body].leave > t &&
        (segment->kind != IMP_SEGMENT_DENSE || tracks->tracks[body].leave == INFINITY))
        return IMPACT_OK;
    const imp_box box = fat_box(&tracks->tracks[body], &tracks->world->bodies[body], t);
    const impact_status status = imp_grid_put(&tracks->grid, body, &box);
    put_slot(tracks, body, t);
    return status == IMPACT_OK ? renew_pairs(tracks, body, t) : status;
}

impact_status imp_tracks_leap(imp_tracks *tracks, int body, double t)
{
    const imp_track *track = &tracks->tracks[body];
    while (track->companion_count > 0) drop_near(tracks, track->companions[track->companion_count - 1].near);
    return renew_box(tracks, body, t);
}

void imp_tracks_begin_look(imp_tracks *tracks) { tracks->round++; }

void imp_tracks_look_ahead(imp_tracks *tracks, int body, double t)
{
    imp_track *track = &tracks->tracks[body];
    bool changed = false;
    track->round = tracks->round;
    for (int k = 0; k < track->companion_count; k++) {
        const int n = track->companions[k].near, other = track->companions[k].other;
        if (tracks->tracks[other].round == tracks->round) continue;
        if (!predict(tracks, &tracks->near[n], t)) continue;
        if (hear(tracks, other, n)) set_slot(tracks, other);
        changed |= hear(tracks, body, n);
    }
    if (changed) set_slot(tracks, body);
}

impact_status imp_tracks_due(imp_tracks *tracks, int body, double t, int *touching)
{
    imp_track *track = &tracks->tracks[body];
    *touching = -1;
    if (track->leave <= t && track->leave <= track->meet) return renew_box(tracks, body, t);
    imp_near *near = &tracks->near[track->first_near];
    if (near->touches) {
        *touching = track->first_near;
        return IMPACT_OK;
    }
    const int n = track->first_near;
    search(tracks, near, near->t);
    tell(tracks, n);
    return IMPACT_OK;
}
