/* SPDX-License-Identifier: MIT
 *
 * A brick that overhangs another: the gap of two boxes, and the patch on which it stands. It falls when its centre is
 * beyond the patch.
 *
 *     cc stack.c $(pkg-config --cflags --libs impact) -o stack && ./stack
 */
#include <stdio.h>
#include <impact/impact.h>

int main(void)
{
    impact_solid brick = {.orientation = {1, 0, 0, 0}}, table = brick;
    impact_shape_box(0.12, 0.06, 0.035, 0.002, &brick.shape);
    table.shape = brick.shape;
    for (int i = 1; i <= 4; i++) {
        impact_contact contact;
        impact_patch patch;
        brick.position = (qvec3){0.04 * i, 0, 0.07};
        if (impact_gap(&brick, &table, NULL, &contact) != IMPACT_OK) return 1;
        if (impact_patch_find(&brick, &table, &contact, 1e-12, &patch) != IMPACT_OK) return 1;
        double low = 1, high = -1;
        for (int k = 0; k < patch.count; k++) {
            low = patch.point[k].offset1.x < low ? patch.point[k].offset1.x : low;
            high = patch.point[k].offset1.x > high ? patch.point[k].offset1.x : high;
        }
        printf("overhang %.2f m: %d points, from %.3f to %.3f m of its centre: it %s\n", 0.04 * i, patch.count, low,
               high, low < 0 && high > 0 ? "stands" : "falls");
    }
    return 0;
}
