/* SPDX-License-Identifier: MIT
 *
 * Who runs the scripts: kept in the registry.
 */
#include "impact_core.h"

static const char host_key[] = "impact.host"; /* registry: light userdata */

void impact_lua_set_host(lua_State *L, const impact_lua_host *host)
{
    lua_pushlightuserdata(L, (void *)host);
    lua_setfield(L, LUA_REGISTRYINDEX, host_key);
}

const impact_lua_host *impact_lua_get_host(lua_State *L)
{
    lua_getfield(L, LUA_REGISTRYINDEX, host_key);
    const impact_lua_host *host = lua_touserdata(L, -1);
    lua_pop(L, 1);
    return host;
}
