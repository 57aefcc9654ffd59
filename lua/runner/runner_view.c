/* SPDX-License-Identifier: MIT
 *
 * impact view, impact gltf: the page of a run, and its glTF.
 */
#include "runner.h"

#include <string.h>

static const char ending_of_records[] = ".run";

static void push_option(lua_State *L, double value)
{
    if (value > 0)
        lua_pushnumber(L, value);
    else
        lua_pushnil(L);
}

int impact_runner_view(lua_State *L, int run, impact_runner *runner, const char *name)
{
    lua_pushfstring(L, "%s.%s", name, runner->ending);
    lua_getfield(L, run, runner->shown);
    lua_pushvalue(L, run);
    lua_pushvalue(L, -3);
    push_option(L, runner->tolerance);
    push_option(L, runner->frame_rate);
    lua_call(L, 4, 2);
    if (!lua_isnil(L, -2)) {
        if (!lua_isnil(L, -1) && !runner->quiet)
            printf("note: %s.%s: %s (--frame-rate)\n", name, runner->ending, lua_tostring(L, -1));
        return IMPACT_EXIT_OK;
    }
    fprintf(stderr, "impact: no %s.%s: %s\n", name, runner->ending, lua_tostring(L, -1));
    return IMPACT_EXIT_OUTPUT;
}

static bool ends_as_record(const char *script)
{
    const size_t length = strlen(script), tail = sizeof ending_of_records - 1;
    return length > tail && strcmp(script + length - tail, ending_of_records) == 0;
}

bool impact_runner_is_record(const impact_runner *runner) { return runner->shown && ends_as_record(runner->script); }

int impact_runner_refuse_script(lua_State *L, const impact_runner *runner)
{
    if (!runner->shown && ends_as_record(runner->script))
        return luaL_error(L, "%s: a recorded run is shown by impact view and impact gltf", runner->script);
    if (!runner->shown) return lua_error(L);
    return luaL_error(L,
                      "%s: %s takes a script that returns a scene, or a recorded run, FILE.run, as --record writes it; "
                      "this is neither: %s",
                      runner->script, runner->shown, lua_tostring(L, -1));
}

void impact_runner_push_record(lua_State *L, const impact_runner *runner)
{
    char message[400] = "";
    lua_getglobal(L, "require"); /* gives recorded runs their methods */
    lua_pushliteral(L, "impact");
    lua_call(L, 1, 0);
    impact_run **run = lua_newuserdatauv(L, sizeof *run, 0);
    *run = NULL;
    luaL_setmetatable(L, "impact.run");
    if (impact_run_open(runner->script, &runner->allocator, run, message, sizeof message) < 0)
        luaL_error(L, "%s", message);
}

int impact_runner_view_record(lua_State *L, impact_runner *runner)
{
    char name[256];
    const char *slash = strrchr(runner->script, '/');
    snprintf(name, sizeof name, "%s", slash ? slash + 1 : runner->script);
    *strrchr(name, '.') = '\0'; /* that of .run */
    const int code = impact_runner_view(L, lua_gettop(L), runner, name);
    if (code == IMPACT_EXIT_OK && !runner->quiet) printf("wrote %s/%s.%s\n", runner->directory, name, runner->ending);
    return code;
}
