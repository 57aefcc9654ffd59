/* SPDX-License-Identifier: MIT
 *
 * Scenes in a host that lets floating-point operations trap: it lives, gets the same bits, and has its environment
 * back; flush-to-zero is refused.
 */
#if defined(__linux__)
#define _GNU_SOURCE /* feenableexcept */
#endif
#include <fenv.h>
#include <stdio.h>
#include <string.h>
#include <impact/impact.h>
#include "base/floats.h"
#include "kit/near.h"
#if defined(__SSE2__)
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

static uint64_t hash;

static bool take(void *context, const impact_sample *s)
{
    (void)context;
    const double numbers[] = {s->t, s->position.x, s->position.z, s->orientation.w, s->velocity.x, s->omega.y};
    const unsigned char *bytes = (const unsigned char *)numbers;
    for (size_t i = 0; i < sizeof numbers; i++) hash = (hash ^ bytes[i]) * 1099511628211u; /* FNV-1a */
    return true;
}

/* As the host rounds, and did when the scene was destroyed. */
static int rounding = FE_TONEAREST, rounding_after;

/* Kinds 0 to 3: spheres, superquadrics; without and with a force. */
static impact_status run(int kind, char *message)
{
    impact_scene_def def = impact_default_scene_def();
    impact_body_def bodies[3];
    impact_force_def force = impact_default_force_def(IMPACT_FORCE_WIND);
    for (int i = 0; i < 3; i++) {
        bodies[i] = impact_default_body_def();
        bodies[i].name = i == 0 ? "floor" : i == 1 ? "a" : "b";
        bodies[i].friction = bodies[i].restitution = 0.6;
        if (kind & 1)
            impact_shape_superquadric(0.3, 0.2, 0.25, 2, 3, 2.5, &bodies[i].shape);
        else
            impact_shape_sphere(0.2, &bodies[i].shape);
        bodies[i].position = (qvec3){0.7 * i, 0, 0.5 + 0.05 * i};
        bodies[i].omega = (qvec3){1, 2, 0.5};
    }
    bodies[0].is_static = true;
    bodies[0].position = bodies[0].omega = (qvec3){0, 0, 0};
    impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape);
    force.name = "wind";
    force.direction = (qvec3){1, 0, 0};
    force.strength = 20;
    force.reach = force.radius = INFINITY;
    def.bodies = bodies;
    def.body_count = 3;
    def.forces = &force;
    def.force_count = kind / 2;
    def.duration = 0.5;
    impact_scene *scene;
    hash = 14695981039346656037u;
    message[0] = '\0';
    fesetround(rounding);
    impact_status status = impact_scene_create(&def, &scene, message, 300);
    if (status < 0) return status;
    status = impact_scene_run(scene, &(impact_recorder){.struct_size = sizeof(impact_recorder), .sample = take});
    snprintf(message, 300, "%s", impact_scene_message(scene));
    impact_scene_destroy(scene);
    rounding_after = fegetround();
    fesetround(FE_TONEAREST);
    return status;
}

static void traps_are_survived(void **state)
{
    (void)state;
#if defined(__GLIBC__)
    const int traps = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
    for (int kind = 0; kind < (impact_has(IMPACT_PART_CVODE) ? 4 : 1); kind++) {
        char message[300];
        if (run(kind, message) < 0) fail_msg("%s", message);
        const uint64_t wanted = hash;
        feclearexcept(FE_ALL_EXCEPT);
        feraiseexcept(FE_INEXACT);
        feenableexcept(traps);
        const impact_status status = run(kind, message);
        const int after = fegetexcept(), flags = fetestexcept(FE_ALL_EXCEPT & ~FE_UNDERFLOW);
        fedisableexcept(FE_ALL_EXCEPT);
        if (status < 0) fail_msg("%s", message);
        assert_true(hash == wanted);
        assert_int_equal(after, traps);
        assert_int_equal(flags, FE_INEXACT);
    }
#else
    skip();
#endif
}

/* A host that rounds otherwise gets the same bits, and its rounding back. */
static void rounding_is_to_nearest(void **state)
{
    (void)state;
    const int modes[] = {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    for (int kind = 0; kind < (impact_has(IMPACT_PART_CVODE) ? 4 : 1); kind++) {
        char message[300];
        if (run(kind, message) < 0) fail_msg("%s", message);
        const uint64_t wanted = hash;
        for (int m = 0; m < 3; m++) {
            rounding = modes[m];
            const impact_status status = run(kind, message);
            rounding = FE_TONEAREST;
            if (status < 0) fail_msg("%s", message);
            assert_true(hash == wanted);
            assert_int_equal(rounding_after, modes[m]);
        }
    }
}

static void the_time_of_impact_too(void **state)
{
    (void)state;
#if defined(__GLIBC__)
    impact_solid a = {.orientation = quat_identity()}, b = {.position = {2, 0.1, 0}, .orientation = quat_identity()};
    impact_shape_superquadric(0.3, 0.2, 0.25, 2, 3, 2.5, &a.shape);
    impact_shape_superquadric(0.3, 0.2, 0.25, 4, 3, 2.5, &b.shape);
    const impact_motion still = {0}, towards = {.velocity = {-1, 0, 0}};
    double plain, trapped;
    const impact_status wanted = impact_toi(&a, &still, &b, &towards, 3, &plain, NULL);
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    const impact_status status = impact_toi(&a, &still, &b, &towards, 3, &trapped, NULL);
    fedisableexcept(FE_ALL_EXCEPT);
    assert_int_equal(status, wanted);
    assert_true(plain == trapped && plain > 1 && plain < 2);
#else
    skip();
#endif
}

static void flush_to_zero_is_refused(void **state)
{
    (void)state;
    assert_true(imp_floats_are_gradual());
#if defined(__SSE2__)
    for (int kind = 0; kind < 2; kind++) {
        char message[300];
        const unsigned before = _mm_getcsr();
        if (kind == 0)
            _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
        else
            _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
        const impact_status status = run(0, message);
        _mm_setcsr(before);
        assert_int_equal(status, IMPACT_EDOMAIN);
        assert_non_null(strstr(message, "flushes small numbers to zero"));
    }
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(traps_are_survived),
        cmocka_unit_test(rounding_is_to_nearest),
        cmocka_unit_test(the_time_of_impact_too),
        cmocka_unit_test(flush_to_zero_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
