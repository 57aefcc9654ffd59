/* SPDX-License-Identifier: MIT */
#include "run/run.h"

#include <stdint.h>
#include <string.h>

const imp_run_table imp_run_tables[IMP_RUN_TABLES] = {
    {"keys", IMP_KEY_COLUMNS, {"t",  "x",  "y",  "z",  "qw", "qx", "qy",  "qz",  "vx",  "vy",  "vz",
                               "wx", "wy", "wz", "ax", "ay", "az", "dwx", "dwy", "dwz", "form"}},
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

void imp_run_key_row(const impact_key *k, double row[IMP_KEY_COLUMNS])
{
    const double values[IMP_KEY_COLUMNS] = {k->t,
                                            k->position.x,
                                            k->position.y,
                                            k->position.z,
                                            k->orientation.w,
                                            k->orientation.x,
                                            k->orientation.y,
                                            k->orientation.z,
                                            k->velocity.x,
                                            k->velocity.y,
                                            k->velocity.z,
                                            k->omega.x,
                                            k->omega.y,
                                            k->omega.z,
                                            k->acceleration.x,
                                            k->acceleration.y,
                                            k->acceleration.z,
                                            k->alpha.x,
                                            k->alpha.y,
                                            k->alpha.z,
                                            k->form};
    memcpy(row, values, sizeof values);
}

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

/* Division by x^32 + x^26 + ... + 1, the lowest power in the highest bit. */
static uint32_t crc32(const char *bytes, size_t size)
{
    uint32_t table[256], crc = UINT32_MAX;
    for (uint32_t i = 0; i < 256; i++) {
        table[i] = i;
        for (int bit = 0; bit < 8; bit++) table[i] = table[i] >> 1 ^ (table[i] & 1 ? 0xEDB88320 : 0);
    }
    for (size_t i = 0; i < size; i++) crc = crc >> 8 ^ table[(crc ^ (unsigned char)bytes[i]) & 255];
    return ~crc;
}

static void seal_of(const char *bytes, size_t size, char seal[IMP_RUN_SEAL])
{
    const uint32_t crc = crc32(bytes, size);
    memset(seal, 0, IMP_RUN_SEAL);
    for (int i = 0; i < 4; i++) seal[i] = (char)(crc >> 8 * i & 255);
}

void imp_run_seal(imp_text *record)
{
    char seal[IMP_RUN_SEAL];
    if (record->failed) return;
    seal_of(record->bytes, record->size, seal);
    imp_text_put(record, seal, sizeof seal);
}

bool imp_run_is_sealed(const char *bytes, size_t size)
{
    char seal[IMP_RUN_SEAL];
    if (size < sizeof seal) return false;
    seal_of(bytes, size - sizeof seal, seal);
    return memcmp(bytes + size - sizeof seal, seal, sizeof seal) == 0;
}
