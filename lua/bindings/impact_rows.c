/* SPDX-License-Identifier: MIT
 *
 * Rows of samples and events as Lua sees them, one by one and as a run keeps them.
 */
#include "impact_scene.h"

#include <stdio.h>
#include <string.h>

/* ---- one row ---- */

void impact_lua_push_sample(lua_State *L, const impact_sample *sample)
{
    luaL_checkstack(L, 6, NULL);
    lua_createtable(L, 0, 6);
    quat_lua_set_number(L, "t", sample->t);
    quat_lua_set_string(L, "body", sample->name);
    quat_lua_set_vec3(L, "position", sample->position);
    quat_lua_set_quat(L, "orientation", sample->orientation);
    quat_lua_set_vec3(L, "velocity", sample->velocity);
    quat_lua_set_vec3(L, "omega", sample->omega);
    quat_lua_seal(L, "the state of a body");
}

void impact_lua_push_event(lua_State *L, const impact_event *event, const char *phases)
{
    luaL_checkstack(L, 6, NULL);
    lua_createtable(L, 0, 15);
    quat_lua_set_number(L, "t", event->t);
    quat_lua_set_number(L, "impulse_n", event->impulse_normal);
    quat_lua_set_number(L, "impulse_t", event->impulse_tangential);
    quat_lua_set_number(L, "un_before", event->normal_before);
    quat_lua_set_number(L, "un_after", event->normal_after);
    quat_lua_set_number(L, "energy_before", event->energy_before);
    quat_lua_set_number(L, "energy_after", event->energy_after);
    lua_pushinteger(L, event->encounter);
    lua_setfield(L, -2, "encounter");
    quat_lua_set_string(L, "event", impact_event_name(event->kind));
    quat_lua_set_string(L, "body1", event->name1);
    quat_lua_set_string(L, "body2", event->name2);
    quat_lua_set_string(L, "phases", phases);
    quat_lua_set_vec3(L, "point", event->point);
    quat_lua_set_vec3(L, "normal", event->normal);
    quat_lua_set_vec3(L, "impulse", event->impulse);
    quat_lua_seal(L, "an event");
}

/* ---- keeping rows; the memory is the Lua state's, so that its limit holds ---- */

/* Room for one more of size bytes; false when the memory is out. */
static bool grow(lua_State *L, void **array, size_t count, size_t *capacity, size_t size)
{
    void *context;
    lua_Alloc allocate = lua_getallocf(L, &context);
    if (count < *capacity) return true;
    const size_t wanted = *capacity ? 2 * *capacity : 256;
    void *more = wanted < (size_t)-1 / 2 / size ? allocate(context, *array, *capacity * size, wanted * size) : NULL;
    if (!more) return false;
    *array = more;
    *capacity = wanted;
    return true;
}

void impact_lua_free_rows(lua_State *L, impact_lua_rows *rows)
{
    void *context;
    lua_Alloc allocate = lua_getallocf(L, &context);
    if (rows->samples) allocate(context, rows->samples, rows->sample_capacity * sizeof *rows->samples, 0);
    if (rows->events) allocate(context, rows->events, rows->event_capacity * sizeof *rows->events, 0);
    if (rows->which) allocate(context, rows->which, rows->which_capacity * sizeof *rows->which, 0);
    if (rows->phases) allocate(context, rows->phases, rows->phases_capacity * sizeof *rows->phases, 0);
    *rows = (impact_lua_rows){0};
}

bool impact_lua_keep_sample(lua_State *L, impact_lua_rows *rows, const impact_sample *sample)
{
    void *array = rows->samples;
    if (!grow(L, &array, rows->sample_count, &rows->sample_capacity, sizeof *sample)) return false;
    rows->samples = array;
    rows->samples[rows->sample_count++] = *sample;
    return true;
}

/* The place of these words among the rows' phases; false when the memory is out. */
static bool find_phases(lua_State *L, impact_lua_rows *rows, const char *words, unsigned *place)
{
    size_t k = 0;
    while (k < rows->phases_count && strncmp(rows->phases[k].words, words, sizeof rows->phases[k].words - 1) != 0) k++;
    *place = (unsigned)k;
    if (k < rows->phases_count) return true;
    void *array = rows->phases;
    if (!grow(L, &array, rows->phases_count, &rows->phases_capacity, sizeof *rows->phases)) return false;
    rows->phases = array;
    snprintf(rows->phases[rows->phases_count++].words, sizeof rows->phases->words, "%s", words);
    return true;
}

bool impact_lua_keep_event(lua_State *L, impact_lua_rows *rows, const impact_event *event)
{
    unsigned place;
    if (!find_phases(L, rows, event->phases ? event->phases : "", &place)) return false;
    void *array = rows->events, *which = rows->which;
    if (!grow(L, &array, rows->event_count, &rows->event_capacity, sizeof *rows->events)) return false;
    rows->events = array;
    if (!grow(L, &which, rows->event_count, &rows->which_capacity, sizeof *rows->which)) return false;
    rows->which = which;
    rows->which[rows->event_count] = place;
    rows->events[rows->event_count++] = *event;
    return true;
}

/* ---- giving them back ---- */

static const char *const columns[] = {"t", "x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"};
enum { COLUMNS = sizeof columns / sizeof *columns };

void impact_lua_begin_columns(lua_State *L)
{
    luaL_checkstack(L, COLUMNS + 6, NULL);
    for (int c = 0; c < COLUMNS; c++) lua_newtable(L);
}

void impact_lua_add_columns(lua_State *L, const impact_sample *s, lua_Integer row)
{
    const double values[COLUMNS] = {s->t,
                                    s->position.x,
                                    s->position.y,
                                    s->position.z,
                                    s->orientation.w,
                                    s->orientation.x,
                                    s->orientation.y,
                                    s->orientation.z,
                                    s->velocity.x,
                                    s->velocity.y,
                                    s->velocity.z,
                                    s->omega.x,
                                    s->omega.y,
                                    s->omega.z};
    const int first = lua_gettop(L) - COLUMNS + 1;
    for (int c = 0; c < COLUMNS; c++) {
        lua_pushnumber(L, values[c]);
        lua_rawseti(L, first + c, row);
    }
}

void impact_lua_end_columns(lua_State *L)
{
    const int first = lua_gettop(L) - COLUMNS + 1;
    lua_createtable(L, 0, COLUMNS);
    for (int c = 0; c < COLUMNS; c++) {
        lua_pushvalue(L, first + c);
        lua_setfield(L, -2, columns[c]);
    }
}

void impact_lua_push_track(lua_State *L, const impact_lua_rows *rows, int body)
{
    lua_Integer row = 0;
    impact_lua_begin_columns(L);
    for (size_t i = 0; i < rows->sample_count; i++)
        if (rows->samples[i].body == body) impact_lua_add_columns(L, &rows->samples[i], ++row);
    impact_lua_end_columns(L);
}

void impact_lua_push_events(lua_State *L, const impact_lua_rows *rows)
{
    luaL_checkstack(L, 4, NULL);
    lua_createtable(L, (int)rows->event_count, 0);
    for (size_t i = 0; i < rows->event_count; i++) {
        impact_lua_push_event(L, &rows->events[i], rows->phases[rows->which[i]].words);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}
