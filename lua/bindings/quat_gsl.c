/* SPDX-License-Identifier: MIT
 *
 * quat.gsl: integrals over surfaces. A module of its own, so that `require "quat"` loads no GSL.
 */
#include "quat_gsl.h"
#include "quat_surface.h"

/* total(surface[, tolerance]) */
static int l_total(lua_State *L)
{
    quat_lua_call call;
    quat_surface_totals totals;
    const double tolerance = quat_lua_arg_number_or(L, 2, "tolerance", QUAT_LUA_POSITIVE, 1e-10);
    if (tolerance < 1e-14) return quat_lua_error(L, "argument 'tolerance' must be at least 1e-14, got %g", tolerance);
    const quat_surface surface = quat_lua_begin_surface(L, &call);
    const quat_status status = quat_surface_total(&surface, tolerance, &totals);
    quat_lua_call_end(&call);
    lua_createtable(L, 0, 4);
    quat_lua_set_number(L, "area", totals.area);
    quat_lua_set_number(L, "gauss", totals.gauss);
    quat_lua_set_number(L, "mean", totals.mean);
    quat_lua_set_number(L, "bending", totals.bending);
    return quat_lua_results(L, status, 1);
}

int luaopen_quat_gsl(lua_State *L)
{
    static const luaL_Reg functions[] = {{"total", l_total}, {NULL, NULL}};
    luaL_checkversion(L); /* header against library */
    luaL_newlib(L, functions);
    return 1;
}
