/* SPDX-License-Identifier: MIT
 *
 * Meshes against what the library says of the shape itself: a corner with normal n stands where the support function
 * says, n . x = h(n); by the divergence theorem the triangles close round the shape's volume; and those of one kind
 * stand in octants of one sign.
 */
#include "../../../view/mesh.h"
#include "kit/near.h"

#include <impact/impact.h>
#include <math.h>
#include <quat/rotation.h>
#include <stdint.h>

static qvec3 three_at(const imp_text *list, uint32_t i)
{
    const float *v = (const float *)(const void *)list->bytes + 3 * (size_t)i;
    return (qvec3){v[0], v[1], v[2]};
}

/* What the mesh's normals stand off the support function, its volume, and triangles that stand in the wrong octant. */
static void look(const impact_body_def *body, double *off, double *volume, int *astray)
{
    imp_mesh mesh;
    imp_arena *arena;
    assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
    assert_true(imp_mesh_of(arena, body, &mesh));
    *off = *volume = 0, *astray = 0;
    for (uint32_t i = 0; i < mesh.points.size / 12; i++) {
        const qvec3 n = three_at(&mesh.normals, i);
        const qvec3 x = qvec3_sub(three_at(&mesh.points, i), body->shape_position);
        const qvec3 own = quat_rotate_inverse(body->shape_orientation, n);
        assert_near(qvec3_norm(n), 1, 2e-7);
        *off = fmax(*off, fabs(impact_shape_support(&body->shape, own, NULL) - qvec3_dot(n, x)));
    }
    for (int kind = 0; kind < 2; kind++) {
        const uint32_t *corner = (const uint32_t *)(const void *)mesh.index[kind].bytes;
        for (size_t i = 0; i < mesh.index[kind].size / 12; i++, corner += 3) {
            qvec3 x[3], middle = {0, 0, 0};
            for (int c = 0; c < 3; c++) {
                const qvec3 off_center = qvec3_sub(three_at(&mesh.points, corner[c]), body->shape_position);
                x[c] = quat_rotate_inverse(body->shape_orientation, off_center);
                middle = qvec3_add(middle, x[c]);
            }
            const double six = qvec3_dot(x[0], qvec3_cross(x[1], x[2]));
            *volume += six / 6;
            if (six > 1e-9 && (middle.x * middle.y * middle.z < 0) != (kind == 1)) ++*astray;
        }
    }
    imp_mesh_free(&mesh);
    assert_int_equal(imp_arena_memory(arena).used, 0);
    imp_arena_destroy(arena);
}

/* coarse: what chords of the rounding cut off, of the volume and m. */
static void check(impact_shape shape, double coarse)
{
    double off, volume;
    int astray;
    impact_body_def body = {.shape = shape, .shape_position = {0.1, -0.2, 0.3}};
    quat_normalize((quat){1, 0.4, -0.3, 0.7}, &body.shape_orientation);
    look(&body, &off, &volume, &astray);
    const double true_volume = impact_shape_volume(&shape);
    assert_true(off <= 1e-6 + coarse);
    assert_true(volume <= true_volume * (1 + 1e-6) && volume >= true_volume * (1 - 1e-6 - 2 * coarse));
    assert_int_equal(astray, 0);
}

static void test_faces_are_their_vertices(void **state)
{
    (void)state;
    const qvec3 points[6] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1.2}, {0.4, 0.3, -0.5}};
    for (int rounded = 0; rounded < 2; rounded++) {
        const double r = 0.08 * rounded, coarse = 0.01 * rounded;
        impact_shape shape;
        impact_hull *hull;
        assert_int_equal(impact_shape_box(0.5, 0.4, 0.3, r, &shape), IMPACT_OK);
        check(shape, coarse);
        assert_int_equal(impact_hull_create(points, 6, r, NULL, &hull, NULL, 0), IMPACT_OK);
        assert_int_equal(impact_shape_polyhedron(hull, &shape), IMPACT_OK);
        check(shape, coarse);
        impact_hull_destroy(hull);
        assert_int_equal(impact_shape_cylinder(0.5, 0.3, r, &shape), IMPACT_OK);
        check(shape, 0.005);
        assert_int_equal(impact_shape_cone(0.5, 0.9, r, &shape), IMPACT_OK);
        check(shape, 0.005);
    }
}

static void test_round_ones_close(void **state)
{
    (void)state;
    impact_shape shape;
    assert_int_equal(impact_shape_capsule(0.3, 0.6, &shape), IMPACT_OK);
    check(shape, 0.01);
    assert_int_equal(impact_shape_ellipsoid(0.5, 0.4, 0.3, &shape), IMPACT_OK);
    check(shape, 0.01);
    assert_int_equal(impact_shape_superquadric(0.5, 0.4, 0.3, 3, 4, 5, &shape), IMPACT_OK);
    check(shape, 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_faces_are_their_vertices),
        cmocka_unit_test(test_round_ones_close),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
