/* SPDX-License-Identifier: MIT
 *
 * impact.collide_together{}: many contacts struck at one instant, from Lua.
 */
#include <impact/together.h>
#include "impact_collide.h"

static const char *const together_keys[] = {"bodies", "contacts", "law", "exponent", "restitution", NULL};
static const char *const body_keys[] = {"name", "m", "J", "v", "w", NULL};
static const char *const contact_keys[] = {"body1", "body2", "n", "r1", "r2", "mu", "eps", "k", "pressed", NULL};
static const char *const together_laws[] = {"springs", "moreau", "sequence", NULL};

/* ---- reading ---- */

/* The list under the key, left on the stack; its length. */
static int push_list(const quat_lua_reader *reader, const char *key)
{
    quat_lua_need(reader, key);
    if (quat_lua_push(reader, key) != LUA_TTABLE) quat_lua_reader_error(reader, "%s must be a list of tables", key);
    const lua_Unsigned length = lua_rawlen(reader->L, -1);
    if (length < 1 || length > 100000)
        quat_lua_reader_error(reader, "%s: 1 to 100000 are needed, got %d", key, (int)length);
    return (int)length;
}

static impact_collider read_body(const quat_lua_reader *outer, int list, int i)
{
    static const qvec3 zero = {0, 0, 0};
    lua_State *L = outer->L;
    lua_rawgeti(L, list, i);
    const quat_lua_reader reader = quat_lua_read(L, lua_gettop(L), "body", outer->where, body_keys);
    impact_collider body = {.orientation = {1, 0, 0, 0}};
    body.mass = quat_lua_get_number(&reader, "m", QUAT_LUA_POSITIVE_OR_INF, INFINITY);
    body.velocity = quat_lua_get_vec3(&reader, "v", zero);
    body.omega = quat_lua_get_vec3(&reader, "w", zero);
    if (!isinf(body.mass)) {
        quat_lua_need(&reader, "J");
        quat_lua_push(&reader, "J");
        impact_lua_read_inertia(&reader, "J", &body.moments, &body.orientation);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return body;
}

static impact_meeting read_contact(const quat_lua_reader *outer, int list, int i, int bodies)
{
    static const qvec3 zero = {0, 0, 0};
    lua_State *L = outer->L;
    lua_rawgeti(L, list, i);
    const quat_lua_reader reader = quat_lua_read(L, lua_gettop(L), "contact", outer->where, contact_keys);
    const char *const needed[] = {"body1", "body2", "n"};
    for (int k = 0; k < 3; k++) quat_lua_need(&reader, needed[k]);
    const impact_meeting m = {.body1 = (int)quat_lua_get_integer(&reader, "body1", 1, bodies, 1) - 1,
                              .body2 = (int)quat_lua_get_integer(&reader, "body2", 1, bodies, 1) - 1,
                              .normal = quat_lua_get_vec3(&reader, "n", zero),
                              .offset1 = quat_lua_get_vec3(&reader, "r1", zero),
                              .offset2 = quat_lua_get_vec3(&reader, "r2", zero),
                              .friction = quat_lua_get_number(&reader, "mu", QUAT_LUA_NOT_NEGATIVE, 0),
                              .restitution = quat_lua_get_number(&reader, "eps", QUAT_LUA_FRACTION, 0),
                              .stiffness = quat_lua_get_number(&reader, "k", QUAT_LUA_POSITIVE, 1),
                              .pressed = quat_lua_get_boolean(&reader, "pressed", false)};
    lua_pop(L, 1);
    return m;
}

/* ---- results ---- */

static void push_contact(lua_State *L, const impact_meeting_outcome *m)
{
    lua_createtable(L, 0, 9);
    quat_lua_set_vec3(L, "impulse", m->impulse);
    quat_lua_set_number(L, "normal_before", m->normal_before);
    quat_lua_set_number(L, "normal_after", m->normal_after);
    lua_createtable(L, 0, 3);
    quat_lua_set_number(L, "compression", m->work_compression);
    quat_lua_set_number(L, "restitution", m->work_restitution);
    quat_lua_set_number(L, "friction", m->work_friction);
    lua_setfield(L, -2, "work");
    lua_createtable(L, m->phase_count, 0);
    for (int i = 0; i < m->phase_count; i++) {
        lua_pushstring(L, impact_phase_name((impact_phase)m->phases[i]));
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "phases");
    quat_lua_set_integer(L, "compressions", m->compressions);
    quat_lua_set_integer(L, "group", m->group + 1);
    quat_lua_set_boolean(L, "merged", m->merged);
}

static void push_vectors(lua_State *L, const char *key, const qvec3 *values, int count)
{
    lua_createtable(L, count, 0);
    for (int i = 0; i < count; i++) {
        quat_lua_push_vec3(L, values[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, key);
}

static void push_together(lua_State *L, const impact_encounter *e, const impact_together_outcome *o,
                          impact_status status)
{
    lua_createtable(L, 0, 14);
    push_vectors(L, "v", o->velocity, e->body_count);
    push_vectors(L, "w", o->omega, e->body_count);
    lua_createtable(L, e->meeting_count, 0);
    for (int i = 0; i < e->meeting_count; i++) {
        push_contact(L, &o->meetings[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "contacts");
    quat_lua_set_number(L, "energy_before", o->energy_before);
    quat_lua_set_number(L, "energy_after", o->energy_after);
    quat_lua_set_number(L, "residual", o->residual);
    quat_lua_set_number(L, "error", o->error);
    quat_lua_set_integer(L, "groups", o->groups);
    quat_lua_set_integer(L, "events", o->events);
    quat_lua_set_integer(L, "steps", o->steps);
    quat_lua_set_boolean(L, "chosen", o->chosen);
    quat_lua_set_boolean(L, "ended_early", o->ended_early);
    quat_lua_set_boolean(L, "energy_rose", o->energy_rose);
    quat_lua_set_string(L, "solver", impact_together_solver_name(o->solver));
    quat_lua_set_string(L, "status",
                        status == IMPACT_SEPARATING ? "separating"
                        : status == IMPACT_SOFT     ? "soft"
                                                    : "ok");
}

/* ---- the door ---- */

int impact_lua_collide_together(lua_State *L)
{
    const quat_lua_reader reader = quat_lua_read(L, 1, "encounter", NULL, together_keys);
    luaL_checkstack(L, 30, "collide_together");
    const int body_count = push_list(&reader, "bodies"), body_list = lua_gettop(L);
    const int meeting_count = push_list(&reader, "contacts"), contact_list = lua_gettop(L);
    /* Blocks of Lua's own: nothing leaks when reading raises. */
    impact_collider *bodies = lua_newuserdatauv(L, sizeof *bodies * (size_t)body_count, 0);
    impact_meeting *meetings = lua_newuserdatauv(L, sizeof *meetings * (size_t)meeting_count, 0);
    qvec3 *after = lua_newuserdatauv(L, sizeof *after * 2 * (size_t)body_count, 0);
    impact_meeting_outcome *each = lua_newuserdatauv(L, sizeof *each * (size_t)meeting_count, 0);
    for (int i = 0; i < body_count; i++) bodies[i] = read_body(&reader, body_list, i + 1);
    for (int i = 0; i < meeting_count; i++) meetings[i] = read_contact(&reader, contact_list, i + 1, body_count);
    const impact_encounter e = {
        .bodies = bodies,
        .body_count = body_count,
        .meetings = meetings,
        .meeting_count = meeting_count,
        .law = (impact_together_law)quat_lua_get_choice(&reader, "law", together_laws, IMPACT_TOGETHER_SPRINGS),
        .exponent = quat_lua_get_number(&reader, "exponent", QUAT_LUA_NOT_NEGATIVE, 0),
        .restitution = (impact_law)quat_lua_get_choice(&reader, "restitution", impact_lua_laws, IMPACT_POISSON)};
    char message[300];
    if (impact_collide_together_check(&e, message, sizeof message) != IMPACT_OK)
        quat_lua_reader_error(&reader, "%s (counted from 0)", message);
    impact_together_outcome o = {.velocity = after, .omega = after + body_count, .meetings = each};
    const impact_status status = impact_collide_together(&e, &o);
    if (o.wedged >= 0) return quat_lua_failure(L, "the bodies are wedged: no motion takes all contacts apart");
    if (status < 0) return quat_lua_failure(L, impact_status_string(status));
    push_together(L, &e, &o, status);
    return 1;
}
