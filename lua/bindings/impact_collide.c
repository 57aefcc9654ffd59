/* SPDX-License-Identifier: MIT
 *
 * impact.collide{}: one impact from Lua.
 */
#include "impact_collide.h"

#include <string.h>

const char *const impact_lua_laws[] = {"poisson", "newton", "stronge", NULL};
const char *const impact_lua_solvers[] = {"auto", "closed_form", "series", "cvode", NULL};

/* ---- reading ---- */

static bool is_matrix(lua_State *L, int index)
{
    const bool rows = lua_rawgeti(L, index, 1) == LUA_TTABLE;
    lua_pop(L, 1);
    return rows;
}

static void read_tensor(const quat_lua_reader *reader, const char *key, int index, qmat3 *tensor)
{
    lua_State *L = reader->L;
    for (int i = 0; i < 3; i++) {
        if (lua_rawgeti(L, index, i + 1) != LUA_TTABLE)
            quat_lua_reader_error(reader, "%s: row %d is missing", key, i + 1);
        for (int j = 0; j < 3; j++) {
            int is_number;
            lua_rawgeti(L, -1, j + 1);
            tensor->m[i][j] = lua_tonumberx(L, -1, &is_number);
            if (!is_number || !isfinite(tensor->m[i][j]))
                quat_lua_reader_error(reader, "%s: entry (%d, %d) must be a finite number", key, i + 1, j + 1);
            lua_pop(L, 1);
        }
        lua_pop(L, 1);
    }
}

void impact_lua_read_inertia(const quat_lua_reader *reader, const char *key, qvec3 *moments, quat *orientation)
{
    static const char *const keys[] = {"moments", "orientation", NULL};
    lua_State *L = reader->L;
    const int index = lua_gettop(L);
    if (lua_type(L, index) != LUA_TTABLE)
        quat_lua_reader_error(reader, "%s must be a 3 x 3 table or {moments=, orientation=}, got a %s", key,
                              luaL_typename(L, index));
    if (is_matrix(L, index)) {
        qmat3 tensor;
        read_tensor(reader, key, index, &tensor);
        if (impact_principal_axes(&tensor, moments, orientation) != IMPACT_OK)
            quat_lua_reader_error(reader, "%s must be symmetric and positive definite", key);
        return;
    }
    const quat_lua_reader inner = quat_lua_read(L, index, key, reader->where, keys);
    quat_lua_need(&inner, "moments");
    *moments = quat_lua_get_vec3(&inner, "moments", *moments);
    *orientation = quat_lua_get_quat(&inner, "orientation", quat_identity());
    if (quat_normalize(*orientation, orientation) != QUAT_OK)
        quat_lua_reader_error(&inner, "orientation has no direction");
}

static void read_collider(const quat_lua_reader *reader, int number, impact_collider *body)
{
    static const char *const names[2][5] = {{"m1", "J1", "r1", "v1", "w1"}, {"m2", "J2", "r2", "v2", "w2"}};
    static const qvec3 zero = {0, 0, 0};
    const char *const *key = names[number];
    lua_State *L = reader->L;
    *body = (impact_collider){.orientation = {1, 0, 0, 0}};
    body->mass = quat_lua_get_number(reader, key[0], QUAT_LUA_POSITIVE_OR_INF, INFINITY);
    body->offset = quat_lua_get_vec3(reader, key[2], zero);
    body->velocity = quat_lua_get_vec3(reader, key[3], zero);
    body->omega = quat_lua_get_vec3(reader, key[4], zero);
    if (isinf(body->mass)) return;
    quat_lua_need(reader, key[1]);
    lua_getfield(L, reader->index, key[1]);
    impact_lua_read_inertia(reader, key[1], &body->moments, &body->orientation);
    lua_pop(L, 1);
}

/* ---- friction laws ---- */

typedef struct law_call {
    lua_State *L;
    int function; /* stack index */
    bool failed;  /* the error's message is then on top of the stack */
} law_call;

static double call_law(double speed, void *context)
{
    law_call *call = context;
    lua_State *L = call->L;
    if (call->failed) return NAN;
    lua_pushvalue(L, call->function);
    lua_pushnumber(L, speed);
    if (lua_pcall(L, 1, 1, 0) != LUA_OK) {
        call->failed = true;
        return NAN;
    }
    int is_number;
    const double mu = lua_tonumberx(L, -1, &is_number);
    if (!is_number || !(mu >= 0 && isfinite(mu))) {
        lua_pop(L, 1);
        lua_pushfstring(L, "mu(%f) must be a number >= 0", speed);
        call->failed = true;
        return NAN;
    }
    lua_pop(L, 1);
    return mu;
}

/* ---- results ---- */

static void push_outcome(lua_State *L, const impact_outcome *o, impact_status status)
{
    lua_createtable(L, 0, 20);
    quat_lua_set_vec3(L, "v1", o->velocity[0]);
    quat_lua_set_vec3(L, "w1", o->omega[0]);
    quat_lua_set_vec3(L, "v2", o->velocity[1]);
    quat_lua_set_vec3(L, "w2", o->omega[1]);
    quat_lua_set_vec3(L, "impulse", o->impulse);
    quat_lua_set_number(L, "impulse_normal", o->impulse_normal);
    quat_lua_set_number(L, "impulse_tangential", o->impulse_tangential);
    quat_lua_set_number(L, "compression_impulse", o->compression_impulse);
    quat_lua_set_number(L, "normal_before", o->normal_before);
    quat_lua_set_number(L, "normal_after", o->normal_after);
    quat_lua_set_number(L, "energy_before", o->energy_before);
    quat_lua_set_number(L, "energy_after", o->energy_after);
    quat_lua_set_number(L, "conditioning", o->conditioning);
    quat_lua_set_number(L, "error", o->error);
    lua_createtable(L, 0, 3);
    quat_lua_set_number(L, "compression", o->work_compression);
    quat_lua_set_number(L, "restitution", o->work_restitution);
    quat_lua_set_number(L, "friction", o->work_friction);
    lua_setfield(L, -2, "work");
    lua_createtable(L, o->phase_count, 0);
    for (int i = 0; i < o->phase_count; i++) {
        lua_pushstring(L, impact_phase_name((impact_phase)o->phases[i]));
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "phases");
    lua_createtable(L, o->phase_count, 0);
    for (int i = 0; i < o->phase_count; i++) {
        quat_lua_push_vec3(L, o->phase_impulse[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "phase_impulses");
    quat_lua_set_integer(L, "compressions", o->compressions);
    quat_lua_set_boolean(L, "energy_rose", o->energy_rose);
    quat_lua_set_boolean(L, "jammed", o->jammed);
    quat_lua_set_boolean(L, "second", o->second);
    quat_lua_set_string(L, "solver", impact_solver_name(o->solver));
    quat_lua_set_string(L, "status",
                        status == IMPACT_SEPARATING ? "separating"
                        : status == IMPACT_SOFT     ? "soft"
                                                    : "ok");
}

/* ---- an outcome read back ---- */

/* The words of a list, as phases. */
static void read_phases(const quat_lua_reader *reader, impact_outcome *o)
{
    lua_State *L = reader->L;
    if (quat_lua_push(reader, "phases") != LUA_TTABLE) quat_lua_reader_error(reader, "phases must be a list");
    const int list = lua_gettop(L);
    for (int i = 1; o->phase_count < IMPACT_MAX_PHASES && lua_rawgeti(L, list, i) == LUA_TSTRING; i++) {
        const char *word = lua_tostring(L, -1);
        int phase = IMPACT_SLIP_C;
        while (phase <= IMPACT_TANGENTIAL && strcmp(word, impact_phase_name((impact_phase)phase)) != 0) phase++;
        if (phase > IMPACT_TANGENTIAL) quat_lua_reader_error(reader, "phases: '%s' is no phase", word);
        o->phases[o->phase_count++] = (unsigned char)phase;
    }
    if (quat_lua_push(reader, "phase_impulses") != LUA_TTABLE)
        quat_lua_reader_error(reader, "phase_impulses must be a list");
    for (int i = 0; i < o->phase_count; i++) {
        lua_rawgeti(L, -1, i + 1);
        o->phase_impulse[i] = quat_lua_arg_vec3(L, lua_gettop(L), "phase_impulses");
        lua_pop(L, 1);
    }
    lua_settop(L, list - 1);
}

static void read_work(const quat_lua_reader *reader, impact_outcome *o)
{
    static const char *const keys[] = {"compression", "restitution", "friction", NULL};
    quat_lua_need(reader, "work");
    quat_lua_push(reader, "work");
    const quat_lua_reader work = quat_lua_read(reader->L, lua_gettop(reader->L), "work", reader->where, keys);
    o->work_compression = quat_lua_get_number(&work, "compression", QUAT_LUA_FINITE, 0);
    o->work_restitution = quat_lua_get_number(&work, "restitution", QUAT_LUA_FINITE, 0);
    o->work_friction = quat_lua_get_number(&work, "friction", QUAT_LUA_FINITE, 0);
    lua_pop(reader->L, 1);
}

/* A table as push_outcome makes it. */
static impact_outcome read_outcome(lua_State *L, int index)
{
    static const char *const keys[] = {"v1",
                                       "w1",
                                       "v2",
                                       "w2",
                                       "impulse",
                                       "impulse_normal",
                                       "impulse_tangential",
                                       "compression_impulse",
                                       "normal_before",
                                       "normal_after",
                                       "energy_before",
                                       "energy_after",
                                       "conditioning",
                                       "error",
                                       "work",
                                       "phases",
                                       "phase_impulses",
                                       "compressions",
                                       "energy_rose",
                                       "jammed",
                                       "second",
                                       "solver",
                                       "status",
                                       NULL};
    const quat_lua_reader reader = quat_lua_read(L, index, "outcome", NULL, keys);
    impact_outcome o = {.compressions = (int)quat_lua_get_integer(&reader, "compressions", 0, 1000, 1)};
    const qvec3 none = {NAN, NAN, NAN};
    struct {
        const char *key;
        double *value;
    } const numbers[] = {{"impulse_normal", &o.impulse_normal},
                         {"impulse_tangential", &o.impulse_tangential},
                         {"compression_impulse", &o.compression_impulse},
                         {"normal_before", &o.normal_before},
                         {"normal_after", &o.normal_after},
                         {"energy_before", &o.energy_before},
                         {"energy_after", &o.energy_after}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        quat_lua_need(&reader, numbers[i].key);
        *numbers[i].value = quat_lua_get_number(&reader, numbers[i].key, QUAT_LUA_FINITE, 0);
    }
    o.velocity[0] = quat_lua_get_vec3(&reader, "v1", none);
    o.velocity[1] = quat_lua_get_vec3(&reader, "v2", none);
    o.omega[0] = quat_lua_get_vec3(&reader, "w1", none);
    o.omega[1] = quat_lua_get_vec3(&reader, "w2", none);
    o.impulse = quat_lua_get_vec3(&reader, "impulse", none);
    read_work(&reader, &o);
    read_phases(&reader, &o);
    return o;
}

/* ---- the door ---- */

static const char *const collide_keys[] = {"m1",
                                           "J1",
                                           "r1",
                                           "v1",
                                           "w1",
                                           "m2",
                                           "J2",
                                           "r2",
                                           "v2",
                                           "w2",
                                           "n",
                                           "mu",
                                           "eps",
                                           "law",
                                           "solver",
                                           "order",
                                           "any_restitution",
                                           "pressed",
                                           "compliance",
                                           "tolerance",
                                           "method",
                                           NULL};

void impact_lua_read_collision(const quat_lua_reader *reader, impact_collision *c)
{
    *c = (impact_collision){.normal = {0, 0, 1}};
    for (int i = 0; i < 2; i++) read_collider(reader, i, &c->body[i]);
    quat_lua_need(reader, "m1");
    quat_lua_need(reader, "n");
    c->normal = quat_lua_get_vec3(reader, "n", c->normal);
    c->any_restitution = quat_lua_get_boolean(reader, "any_restitution", false);
    c->pressed = quat_lua_get_boolean(reader, "pressed", false);
    c->restitution =
        quat_lua_get_number(reader, "eps", c->any_restitution ? QUAT_LUA_NOT_NEGATIVE : QUAT_LUA_FRACTION, 0);
    c->law = (impact_law)quat_lua_get_choice(reader, "law", impact_lua_laws, IMPACT_POISSON);
    c->solver = (impact_solver)quat_lua_get_choice(reader, "solver", impact_lua_solvers, IMPACT_SOLVER_AUTO);
    c->series_order = (int)quat_lua_get_integer(reader, "order", 8, 32, 0);
    c->tangential_compliance = quat_lua_get_number(reader, "compliance", QUAT_LUA_NOT_NEGATIVE, 0);
}

/* A workspace as asked for by tolerance and method, closed with the value on the stack. */
typedef struct workspace_box {
    impact_collide_workspace *workspace;
} workspace_box;

static const char workspace_kind[] = "impact.collide_workspace";

static int close_box(lua_State *L)
{
    workspace_box *box = luaL_checkudata(L, 1, workspace_kind);
    impact_collide_workspace_destroy(box->workspace);
    box->workspace = NULL;
    return 0;
}

static impact_status make_box(lua_State *L, const quat_lua_reader *reader, impact_collision *c)
{
    static const char *const methods[] = {"adams", "bdf", NULL};
    const double tolerance = quat_lua_get_number(reader, "tolerance", QUAT_LUA_POSITIVE, 1e-12);
    const int method = quat_lua_get_choice(reader, "method", methods, IMPACT_ODE_ADAMS);
    if (!(tolerance >= 1e-14 && tolerance <= 1e-2)) quat_lua_reader_error(reader, "tolerance must be in [1e-14, 1e-2]");
    if (!quat_lua_has(reader, "tolerance") && !quat_lua_has(reader, "method")) return IMPACT_OK;
    workspace_box *box = lua_newuserdatauv(L, sizeof *box, 0);
    box->workspace = NULL;
    luaL_setmetatable(L, workspace_kind);
    const impact_status status = impact_collide_workspace_create((impact_ode_method)method, tolerance, &box->workspace);
    c->workspace = box->workspace;
    return status;
}

/* Reads all of a collision; *call, if it has a friction law, serves that from then on. Raises with the key; a status
 * below 0 where there is no workspace to be had. */
static impact_status read_whole(lua_State *L, const quat_lua_reader *reader, law_call *call, impact_collision *c)
{
    impact_lua_read_collision(reader, c);
    const impact_status status = make_box(L, reader, c);
    if (status != IMPACT_OK) return status;
    lua_getfield(L, 1, "mu");
    *call = (law_call){.L = L, .function = lua_gettop(L)};
    if (lua_isfunction(L, -1)) {
        c->friction_law = call_law;
        c->friction_context = call;
        luaL_checkstack(L, 8, "friction law");
    } else {
        c->friction = quat_lua_get_number(reader, "mu", QUAT_LUA_NOT_NEGATIVE, 0);
    }
    char message[200];
    if (impact_collide_check(c, message, sizeof message) != IMPACT_OK) quat_lua_reader_error(reader, "%s", message);
    return IMPACT_OK;
}

const char *impact_lua_why_no_outcome(impact_status status)
{
    return status == IMPACT_EARGUMENT ? "solver is closed_form, and this impact has none"
                                      : impact_status_string(status);
}

/* collide{m1=, J1=, r1=, v1=, w1=, m2=, ..., n=, mu=, eps=, law=, solver=}: a table, or nil and why there is
 * no answer. */
static int collide(lua_State *L)
{
    const quat_lua_reader reader = quat_lua_read(L, 1, "collision", NULL, collide_keys);
    impact_collision c;
    law_call call;
    impact_status status = read_whole(L, &reader, &call, &c);
    if (status != IMPACT_OK) return quat_lua_failure(L, impact_status_string(status));
    impact_outcome o;
    status = impact_collide(&c, &o);
    if (call.failed) return quat_lua_reader_error(&reader, "mu: %s", lua_tostring(L, -1));
    if (status < 0) return quat_lua_failure(L, impact_lua_why_no_outcome(status));
    push_outcome(L, &o, status);
    return 1;
}

/* collide_sensitivity{...}, as collide: a number, or nil and why there is none. */
static int sensitivity(lua_State *L)
{
    const quat_lua_reader reader = quat_lua_read(L, 1, "collision", NULL, collide_keys);
    impact_collision c;
    law_call call;
    const impact_status status = read_whole(L, &reader, &call, &c);
    if (status != IMPACT_OK) return quat_lua_failure(L, impact_status_string(status));
    const double answer = impact_collide_sensitivity(&c);
    if (call.failed) return quat_lua_reader_error(&reader, "mu: %s", lua_tostring(L, -1));
    if (isnan(answer)) {
        impact_outcome o;
        const impact_status why = impact_collide(&c, &o);
        return quat_lua_failure(L,
                                why < 0 ? impact_lua_why_no_outcome(why) : "an impact with nearby data has no answer");
    }
    lua_pushnumber(L, answer);
    return 1;
}

/* collide_receipt(collision, outcome): a table of residuals in eps, by identity, and the worst. */
static int receipt(lua_State *L)
{
    const quat_lua_reader reader = quat_lua_read(L, 1, "collision", NULL, collide_keys);
    impact_collision c;
    law_call call;
    luaL_checkany(L, 2);
    const impact_status status = read_whole(L, &reader, &call, &c);
    if (status != IMPACT_OK) return quat_lua_failure(L, impact_status_string(status));
    const impact_outcome o = read_outcome(L, 2);
    impact_receipt r;
    impact_collide_receipt(&c, &o, &r);
    struct {
        const char *key;
        double value;
    } const fields[] = {{"momentum", r.momentum},   {"spin", r.spin},   {"cone", r.cone},
                        {"energy", r.energy},       {"power", r.power}, {"law", r.law},
                        {"stick", r.stick},         {"path", r.path},   {"approach", r.approach},
                        {"hodograph", r.hodograph}, {"slips", r.slips}, {"worst", r.worst}};
    lua_createtable(L, 0, 12);
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) quat_lua_set_number(L, fields[i].key, fields[i].value);
    return 1;
}

void impact_lua_open_collide(lua_State *L)
{
    static const luaL_Reg functions[] = {{"collide", collide},
                                         {"collide_many", impact_lua_collide_many},
                                         {"collide_receipt", receipt},
                                         {"collide_sensitivity", sensitivity},
                                         {"collide_together", impact_lua_collide_together},
                                         {"flow", impact_lua_flow},
                                         {NULL, NULL}};
    static const luaL_Reg box_methods[] = {{"__gc", close_box}, {"__close", close_box}, {NULL, NULL}};
    luaL_newmetatable(L, workspace_kind);
    luaL_setfuncs(L, box_methods, 0);
    lua_pop(L, 1);
    luaL_setfuncs(L, functions, 0);
}
