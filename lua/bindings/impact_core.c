/* SPDX-License-Identifier: MIT
 *
 * impact.core: the C side of `require "impact"`.
 */
#include "impact_core.h"

static int core_has(lua_State *L)
{
    static const char *const words[] = {"cvode", "ccd", "view", NULL};
    static const impact_part parts[] = {IMPACT_PART_CVODE, IMPACT_PART_CCD, IMPACT_PART_VIEW};
    lua_pushboolean(L, impact_has(parts[quat_lua_arg_choice(L, 1, "part", words)]));
    return 1;
}

int luaopen_impact_core(lua_State *L)
{
    static void (*const rooms[])(lua_State *) = {
        impact_lua_open_shape,   impact_lua_open_faces,  impact_lua_open_gap,
        impact_lua_open_body,    impact_lua_open_force,  impact_lua_open_scene,
        impact_lua_open_collide, impact_lua_open_record, impact_lua_open_arguments};
    static const luaL_Reg functions[] = {
        {"has", core_has}, {"layer", quat_lua_layer}, {"no_function", quat_lua_no_function}, {NULL, NULL}};
    luaL_checkversion(L); /* header against library */
    luaL_newlib(L, functions);
    lua_pushstring(L, impact_version());
    lua_setfield(L, -2, "version");
    for (size_t i = 0; i < sizeof rooms / sizeof *rooms; i++) rooms[i](L);
    return 1;
}
