/* SPDX-License-Identifier: MIT */
#include "run/run.h"

const imp_run_table imp_run_tables[IMP_RUN_TABLES] = {
    {"keys", IMP_KEY_COLUMNS, {"t",  "x",  "y",  "z",  "qw", "qx", "qy", "qz",  "vx",  "vy",
                               "vz", "wx", "wy", "wz", "ax", "ay", "az", "dwx", "dwy", "dwz"}},
    {"events",
     IMP_EVENT_COLUMNS,
     {"t", "kind", "body1", "body2", "force", "px", "py", "pz", "nx", "ny", "nz", "jx", "jy", "jz", "un_before",
      "un_after", "phases", "energy_before", "energy_after"}},
    {"contacts",
     IMP_CONTACT_COLUMNS,
     {"t", "body1", "body2", "mode", "px", "py", "pz", "nx", "ny", "nz", "fx", "fy", "fz"}},
    {"account",
     IMP_ACCOUNT_COLUMNS,
     {"t", "kinetic", "potential", "force_work", "surface_work", "damping_loss", "sliding_loss", "impact_loss"}},
};

const char *const imp_run_shapes[IMPACT_SHAPE_KINDS] = {
    [IMPACT_SPHERE] = "sphere",
    [IMPACT_PLANE] = "plane",
    [IMPACT_SUPERQUADRIC] = "superquadric",
    [IMPACT_SUPERELLIPSOID] = "superellipsoid",
    [IMPACT_BOX] = "box",
    [IMPACT_CYLINDER] = "cylinder",
    [IMPACT_CONE] = "cone",
    [IMPACT_CAPSULE] = "capsule",
    [IMPACT_POLYHEDRON] = "polyhedron",
};
