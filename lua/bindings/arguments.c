/* SPDX-License-Identifier: MIT */
#include "arguments.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include "guess.h"

/* ---- errors ---- */

static const char layers_key[] = "quat.layers"; /* registry: set of the chunk names of our own layers */

void quat_lua_mark_layer(lua_State *L, const char *source)
{
    luaL_getsubtable(L, LUA_REGISTRYINDEX, layers_key);
    lua_pushboolean(L, 1);
    lua_setfield(L, -2, source);
    lua_pop(L, 1);
}

int quat_lua_layer(lua_State *L)
{
    lua_Debug info;
    if (lua_getstack(L, 1, &info) && lua_getinfo(L, "S", &info)) quat_lua_mark_layer(L, info.source);
    return 0;
}

enum { MOST_NAMES = 400 };

/* (table, key), upvalues: its kind ("function", "field") and whose: an __index that is asked for what is not there. */
static int is_absent(lua_State *L)
{
    const char *names[MOST_NAMES + 1];
    const char *kind = lua_tostring(L, lua_upvalueindex(1)), *owner = lua_tostring(L, lua_upvalueindex(2));
    int count = 0;
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    for (lua_pushnil(L); lua_next(L, 1); lua_pop(L, 1)) /* the names live as long as the table */
        if (lua_type(L, -2) == LUA_TSTRING && count < MOST_NAMES) names[count++] = lua_tostring(L, -2);
    names[count] = NULL;
    const char *given = lua_tostring(L, 2), *meant = quat_lua_guess(given, names);
    if (meant) return quat_lua_error(L, "no %s '%s' in %s (did you mean '%s'?)", kind, given, owner, meant);
    return quat_lua_error(L, "no %s '%s' in %s", kind, given, owner);
}

int quat_lua_no_function(lua_State *L)
{
    luaL_checkstring(L, 1);
    lua_settop(L, 1);
    lua_pushliteral(L, "function");
    lua_insert(L, 1);
    lua_pushcclosure(L, is_absent, 2);
    return 1;
}

void quat_lua_seal(lua_State *L, const char *owner)
{
    luaL_checkstack(L, 4, NULL);
    if (luaL_newmetatable(L, owner)) {
        lua_pushliteral(L, "field");
        lua_pushstring(L, owner);
        lua_pushcclosure(L, is_absent, 2);
        lua_setfield(L, -2, "__index");
    }
    lua_setmetatable(L, -2);
}

void quat_lua_where(lua_State *L)
{
    lua_Debug info;
    luaL_checkstack(L, 3, NULL);
    luaL_getsubtable(L, LUA_REGISTRYINDEX, layers_key);
    for (int level = 0; lua_getstack(L, level, &info); level++) {
        lua_getinfo(L, "Sl", &info);
        if (info.currentline <= 0) continue;
        const bool ours = lua_getfield(L, -1, info.source) != LUA_TNIL;
        lua_pop(L, 1);
        if (ours) continue;
        lua_pop(L, 1);
        lua_pushfstring(L, "%s:%d: ", info.short_src, info.currentline);
        return;
    }
    lua_pop(L, 1);
    lua_pushliteral(L, "");
}

/* Raises "where [kind ['name']: ]message". */
static int raise(lua_State *L, const quat_lua_reader *reader, const char *format, va_list list)
{
    char message[512];
    vsnprintf(message, sizeof message, format, list);
    luaL_checkstack(L, 4, NULL);
    if (reader && reader->where)
        lua_pushstring(L, reader->where);
    else
        quat_lua_where(L);
    if (!reader)
        lua_pushstring(L, message);
    else if (reader->name)
        lua_pushfstring(L, "%s '%s': %s", reader->kind, reader->name, message);
    else
        lua_pushfstring(L, "%s: %s", reader->kind, message);
    lua_concat(L, 2);
    return lua_error(L);
}

int quat_lua_error(lua_State *L, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    raise(L, NULL, format, list);
    va_end(list);
    return 0;
}

int quat_lua_reader_error(const quat_lua_reader *reader, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    raise(reader->L, reader, format, list);
    va_end(list);
    return 0;
}

int quat_lua_failure(lua_State *L, const char *message)
{
    lua_pushnil(L);
    lua_pushstring(L, message);
    return 2;
}

/* Pushes table[key] without metamethods, so that reading a table runs nothing of the script's. */
static int raw_field(lua_State *L, int table, const char *key)
{
    table = lua_absindex(L, table);
    lua_pushstring(L, key);
    return lua_rawget(L, table);
}

int quat_lua_quietly(lua_State *L, lua_CFunction work)
{
    const bool running = lua_gc(L, LUA_GCISRUNNING) == 1;
    const int count = lua_gettop(L);
    lua_gc(L, LUA_GCSTOP);
    lua_pushcfunction(L, work);
    lua_insert(L, 1);
    const int status = lua_pcall(L, count, LUA_MULTRET, 0);
    if (running) lua_gc(L, LUA_GCRESTART);
    return status == LUA_OK ? lua_gettop(L) : lua_error(L);
}

/* ---- one value, of an argument (reader NULL) or of a key ---- */

/* How many keys the table at index has, as far as one more than `most`. */
static int keys_of(lua_State *L, int index, int most)
{
    int count = 0;
    luaL_checkstack(L, 3, NULL);
    index = lua_absindex(L, index);
    lua_pushnil(L);
    while (lua_next(L, index)) {
        lua_pop(L, 1);
        if (++count > most) {
            lua_pop(L, 1);
            break;
        }
    }
    return count;
}

/* Numbers as they stand in a short table, by place or by letter, or in a quaternion; false when it is none of these. */
static bool describe_numbers(lua_State *L, int index, char *text, size_t size)
{
    static const char *const letters[] = {"w", "x", "y", "z"};
    const quat *q = luaL_testudata(L, index, QUAT_LUA_QUAT);
    if (q) {
        snprintf(text, size, "(%g, %g, %g, %g)", q->w, q->x, q->y, q->z);
        return true;
    }
    if (!lua_istable(L, index)) return false;
    index = lua_absindex(L, index);
    luaL_checkstack(L, 2, NULL);
    const lua_Unsigned length = lua_rawlen(L, index);
    size_t used = (size_t)snprintf(text, size, "{");
    int count = 0;
    for (int i = 0; i < 4 && length <= 4; i++) {
        const int type = length > 0 ? lua_rawgeti(L, index, i + 1) : raw_field(L, index, letters[i]);
        const double value = lua_tonumber(L, -1);
        lua_pop(L, 1);
        if (type == LUA_TNIL) continue;
        if (type != LUA_TNUMBER) return false;
        const char *separator = count++ > 0 ? ", " : "";
        if (used < size)
            used += (size_t)snprintf(text + used, size - used, length > 0 ? "%s%s%.6g" : "%s%s = %.6g", separator,
                                     length > 0 ? "" : letters[i], isnan(value) ? (double)NAN : value);
    }
    if (used < size) snprintf(text + used, size - used, keys_of(L, index, count) > count ? " and more}" : "}");
    return count > 0;
}

/* The value at index in words for an error, at most a few dozen characters. */
static const char *describe(lua_State *L, int index, char *text, size_t size)
{
    if (describe_numbers(L, index, text, size)) return text;
    switch (lua_type(L, index)) {
    case LUA_TNUMBER:
        if (lua_isinteger(L, index))
            snprintf(text, size, LUA_INTEGER_FMT, lua_tointeger(L, index));
        else if (isnan(lua_tonumber(L, index)))
            snprintf(text, size, "nan");
        else
            snprintf(text, size, LUA_NUMBER_FMT, lua_tonumber(L, index));
        break;
    case LUA_TSTRING: snprintf(text, size, "the string '%.40s'", lua_tostring(L, index)); break;
    case LUA_TBOOLEAN: snprintf(text, size, "%s", lua_toboolean(L, index) ? "true" : "false"); break;
    case LUA_TNIL:
    case LUA_TNONE: snprintf(text, size, "nothing"); break;
    default: snprintf(text, size, "a %s", luaL_typename(L, index)); break;
    }
    return text;
}

static int refuse(lua_State *L, const quat_lua_reader *reader, const char *key, int index, const char *wanted)
{
    char text[120];
    describe(L, index, text, sizeof text);
    if (reader) return quat_lua_reader_error(reader, "%s must be %s, got %s", key, wanted, text);
    return quat_lua_error(L, "argument '%s' must be %s, got %s", key, wanted, text);
}

static bool in_range(double value, quat_lua_range range)
{
    switch (range) {
    case QUAT_LUA_FINITE: return isfinite(value);
    case QUAT_LUA_POSITIVE: return isfinite(value) && value > 0;
    case QUAT_LUA_NOT_NEGATIVE: return isfinite(value) && value >= 0;
    case QUAT_LUA_FRACTION: return value >= 0 && value <= 1;
    case QUAT_LUA_BELOW_ONE: return value >= 0 && value < 1;
    case QUAT_LUA_POSITIVE_OR_INF: return value > 0;
    }
    return false;
}

static double number_at(lua_State *L, const quat_lua_reader *reader, const char *key, int index, quat_lua_range range)
{
    static const char *const words[] = {
        [QUAT_LUA_FINITE] = "a finite number",       [QUAT_LUA_POSITIVE] = "a positive number",
        [QUAT_LUA_NOT_NEGATIVE] = "a number >= 0",   [QUAT_LUA_FRACTION] = "a number from 0 to 1",
        [QUAT_LUA_BELOW_ONE] = "a number in [0, 1)", [QUAT_LUA_POSITIVE_OR_INF] = "a positive number or math.huge",
    };
    /* Strings that look like numbers are refused: they are mistakes more often than not. */
    if (lua_type(L, index) != LUA_TNUMBER || !in_range(lua_tonumber(L, index), range))
        refuse(L, reader, key, index, words[range]);
    return lua_tonumber(L, index);
}

static lua_Integer integer_at(lua_State *L, const quat_lua_reader *reader, const char *key, int index,
                              lua_Integer least, lua_Integer most)
{
    int exact = 0;
    const lua_Integer value = lua_type(L, index) == LUA_TNUMBER ? lua_tointegerx(L, index, &exact) : 0;
    if (!exact || value < least || value > most) {
        char wanted[96];
        if (most == LUA_MAXINTEGER)
            snprintf(wanted, sizeof wanted, "a whole number >= " LUA_INTEGER_FMT, least);
        else
            snprintf(wanted, sizeof wanted, "a whole number from " LUA_INTEGER_FMT " to " LUA_INTEGER_FMT, least, most);
        refuse(L, reader, key, index, wanted);
    }
    return value;
}

static const char *string_at(lua_State *L, const quat_lua_reader *reader, const char *key, int index)
{
    size_t length = 0;
    const char *text = lua_type(L, index) == LUA_TSTRING ? lua_tolstring(L, index, &length) : NULL;
    if (!text || strlen(text) != length) refuse(L, reader, key, index, "a string");
    return text;
}

static int choice_at(lua_State *L, const quat_lua_reader *reader, const char *key, int index, const char *const words[])
{
    char wanted[256] = "one of";
    const char *given = lua_type(L, index) == LUA_TSTRING ? lua_tostring(L, index) : "";
    for (int i = 0; words[i]; i++) {
        if (strcmp(words[i], given) == 0) return i;
        const size_t used = strlen(wanted);
        snprintf(wanted + used, sizeof wanted - used, "%s '%s'", i > 0 ? "," : "", words[i]);
    }
    return refuse(L, reader, key, index, wanted);
}

/* The components of the table at index, by place or by letter; all must be finite. False when it is not such
 * a table, or has more in it. */
static bool components_at(lua_State *L, int index, const char *letters, double *values)
{
    const int count = (int)strlen(letters);
    index = lua_absindex(L, index);
    if (!lua_istable(L, index)) return false;
    luaL_checkstack(L, 2, NULL);
    const bool by_place = lua_rawlen(L, index) > 0;
    for (int i = 0; i < count; i++) {
        const char letter[2] = {letters[i], 0};
        const int type = by_place ? lua_rawgeti(L, index, i + 1) : raw_field(L, index, letter);
        values[i] = lua_tonumber(L, -1);
        lua_pop(L, 1);
        if (type != LUA_TNUMBER || !isfinite(values[i])) return false;
    }
    return keys_of(L, index, count) == count;
}

static qvec3 vec3_at(lua_State *L, const quat_lua_reader *reader, const char *key, int index)
{
    double v[3] = {0, 0, 0};
    if (!components_at(L, index, "xyz", v)) refuse(L, reader, key, index, "a vector {x, y, z} of finite numbers");
    return (qvec3){v[0], v[1], v[2]};
}

static quat quat_at(lua_State *L, const quat_lua_reader *reader, const char *key, int index)
{
    double v[4] = {1, 0, 0, 0};
    const quat *given = luaL_testudata(L, index, QUAT_LUA_QUAT);
    if (given) {
        v[0] = given->w, v[1] = given->x, v[2] = given->y, v[3] = given->z;
        for (int i = 0; i < 4; i++)
            if (!isfinite(v[i])) refuse(L, reader, key, index, "a quaternion of finite numbers");
    } else if (!components_at(L, index, "wxyz", v)) {
        refuse(L, reader, key, index, "a quaternion or {w, x, y, z} of finite numbers");
    }
    return (quat){v[0], v[1], v[2], v[3]};
}

/* ---- arguments ---- */

double quat_lua_arg_number(lua_State *L, int arg, const char *name, quat_lua_range range)
{
    return number_at(L, NULL, name, arg, range);
}

double quat_lua_arg_number_or(lua_State *L, int arg, const char *name, quat_lua_range range, double fallback)
{
    return lua_isnoneornil(L, arg) ? fallback : number_at(L, NULL, name, arg, range);
}

lua_Integer quat_lua_arg_integer(lua_State *L, int arg, const char *name, lua_Integer least, lua_Integer most)
{
    return integer_at(L, NULL, name, arg, least, most);
}

bool quat_lua_is_vec3(lua_State *L, int index, qvec3 *v)
{
    double value[3];
    if (!components_at(L, index, "xyz", value)) return false;
    *v = (qvec3){value[0], value[1], value[2]};
    return true;
}

const char *quat_lua_describe(lua_State *L, int index, char *text, size_t size)
{
    return describe(L, index, text, size);
}

qvec3 quat_lua_arg_vec3(lua_State *L, int arg, const char *name) { return vec3_at(L, NULL, name, arg); }
quat quat_lua_arg_quat(lua_State *L, int arg, const char *name) { return quat_at(L, NULL, name, arg); }

int quat_lua_refuse(lua_State *L, int arg, const char *name, const char *wanted)
{
    return refuse(L, NULL, name, arg, wanted);
}

int quat_lua_arg_choice(lua_State *L, int arg, const char *name, const char *const words[])
{
    return choice_at(L, NULL, name, arg, words);
}

/* ---- tables ---- */

static bool is_among(const char *given, const char *const keys[])
{
    for (int i = 0; keys[i]; i++)
        if (strcmp(given, keys[i]) == 0) return true;
    return false;
}

/* The keys in words, for those who guess. */
static void list_keys(const char *const keys[], char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (int i = 0; keys[i] && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", i > 0 ? ", " : "", keys[i]);
}

static int unknown_key(const quat_lua_reader *reader, const char *const keys[])
{
    char known[400];
    lua_State *L = reader->L; /* the key is second from the top */
    const char *owner = reader->name ? reader->name : "", *quote = reader->name ? "'" : "",
               *space = reader->name ? " " : "";
    luaL_checkstack(L, 6, NULL);
    if (reader->where)
        lua_pushstring(L, reader->where);
    else
        quat_lua_where(L);
    if (lua_type(L, -3) == LUA_TSTRING) {
        const char *given = lua_tostring(L, -3), *meant = quat_lua_guess(given, keys);
        lua_pushfstring(L, "unknown key '%s' in %s%s%s%s%s", given, reader->kind, space, quote, owner, quote);
        list_keys(keys, known, sizeof known);
        if (meant)
            lua_pushfstring(L, " (did you mean '%s'?)", meant);
        else
            lua_pushfstring(L, " (keys: %s)", known);
    } else {
        const char *given = luaL_tolstring(L, -3, NULL);
        lua_pushfstring(L, "unknown key [%s] in %s%s%s%s%s", given, reader->kind, space, quote, owner, quote);
        lua_remove(L, -2);
        list_keys(keys, known, sizeof known);
        lua_pushfstring(L, " (its values have names: %s)", known);
    }
    lua_concat(L, 3);
    return lua_error(L);
}

quat_lua_reader quat_lua_read(lua_State *L, int index, const char *kind, const char *where, const char *const keys[])
{
    quat_lua_reader reader = {L, lua_absindex(L, index), kind, NULL, where};
    char text[80], known[400];
    if (!lua_istable(L, index)) {
        list_keys(keys, known, sizeof known);
        quat_lua_reader_error(&reader, "a table of its values is needed, got %s (keys: %s)",
                              describe(L, index, text, sizeof text), known);
    }
    luaL_checkstack(L, 4, NULL);
    if (raw_field(L, reader.index, "name") == LUA_TSTRING) reader.name = lua_tostring(L, -1);
    lua_pop(L, 1);
    for (lua_pushnil(L); lua_next(L, reader.index); lua_pop(L, 1))
        if (lua_type(L, -2) != LUA_TSTRING || !is_among(lua_tostring(L, -2), keys)) unknown_key(&reader, keys);
    return reader;
}

int quat_lua_push(const quat_lua_reader *reader, const char *key)
{
    luaL_checkstack(reader->L, 2, NULL);
    return raw_field(reader->L, reader->index, key);
}

bool quat_lua_has(const quat_lua_reader *reader, const char *key)
{
    const bool has = quat_lua_push(reader, key) != LUA_TNIL;
    lua_pop(reader->L, 1);
    return has;
}

void quat_lua_need(const quat_lua_reader *reader, const char *key)
{
    if (!quat_lua_has(reader, key)) quat_lua_reader_error(reader, "%s is missing", key);
}

/* Pushes the key's value; false (and nothing pushed) when it is absent. */
static bool push_field(const quat_lua_reader *reader, const char *key)
{
    if (quat_lua_push(reader, key) != LUA_TNIL) return true;
    lua_pop(reader->L, 1);
    return false;
}

double quat_lua_get_number(const quat_lua_reader *reader, const char *key, quat_lua_range range, double fallback)
{
    if (!push_field(reader, key)) return fallback;
    const double value = number_at(reader->L, reader, key, -1, range);
    lua_pop(reader->L, 1);
    return value;
}

lua_Integer quat_lua_get_integer(const quat_lua_reader *reader, const char *key, lua_Integer lowest, lua_Integer most,
                                 lua_Integer fallback)
{
    if (!push_field(reader, key)) return fallback;
    const lua_Integer value = integer_at(reader->L, reader, key, -1, lowest, most);
    lua_pop(reader->L, 1);
    return value;
}

bool quat_lua_get_boolean(const quat_lua_reader *reader, const char *key, bool fallback)
{
    if (!push_field(reader, key)) return fallback;
    if (!lua_isboolean(reader->L, -1)) refuse(reader->L, reader, key, -1, "true or false");
    const bool value = lua_toboolean(reader->L, -1);
    lua_pop(reader->L, 1);
    return value;
}

const char *quat_lua_get_string(const quat_lua_reader *reader, const char *key, const char *fallback)
{
    if (!push_field(reader, key)) return fallback;
    const char *value = string_at(reader->L, reader, key, -1);
    lua_pop(reader->L, 1);
    return value;
}

int quat_lua_get_choice(const quat_lua_reader *reader, const char *key, const char *const words[], int fallback)
{
    if (!push_field(reader, key)) return fallback;
    const int value = choice_at(reader->L, reader, key, -1, words);
    lua_pop(reader->L, 1);
    return value;
}

qvec3 quat_lua_get_vec3(const quat_lua_reader *reader, const char *key, qvec3 fallback)
{
    if (!push_field(reader, key)) return fallback;
    const qvec3 value = vec3_at(reader->L, reader, key, -1);
    lua_pop(reader->L, 1);
    return value;
}

quat quat_lua_get_quat(const quat_lua_reader *reader, const char *key, quat fallback)
{
    if (!push_field(reader, key)) return fallback;
    const quat value = quat_at(reader->L, reader, key, -1);
    lua_pop(reader->L, 1);
    return value;
}
