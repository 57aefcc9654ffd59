/* SPDX-License-Identifier: MIT
 *
 * The strict reader of JSON: what RFC 8259 has is read, what it has not is refused, cut off at any byte too.
 */
#include "run/json.h"
#include "kit/near.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static imp_arena *arena;

/* From a copy of its own length, so that a byte behind it is seen by sanitizers. */
static const imp_json *read(const char *text, size_t size, impact_status *status)
{
    char *copy = malloc(size + 1);
    memcpy(copy, text, size);
    copy[size] = '7'; /* what a reader that goes on would take */
    const imp_json *root;
    *status = imp_json_read(arena, copy, size, &root);
    free(copy);
    return root;
}

static const imp_json *good(const char *text)
{
    impact_status status;
    const imp_json *root = read(text, strlen(text), &status);
    if (status != IMPACT_OK || !root) fail_msg("refused: %s", text);
    return root;
}

static void refused(const char *text, size_t size)
{
    impact_status status;
    const imp_json *root = read(text, size, &status);
    if (status != IMPACT_EARGUMENT || root) fail_msg("taken: %.*s", (int)size, text);
}

static void values_are_read(void **state)
{
    (void)state;
    assert_int_equal(good("null")->kind, IMP_JSON_NULL);
    assert_int_equal(good(" true\t\r\n")->kind, IMP_JSON_TRUE);
    assert_int_equal(good("false")->kind, IMP_JSON_FALSE);
    static const char *const numbers[] = {"0",        "-0",         "7",      "-12.5",   "0.1",        "1e3",   "1E+3",
                                          "1.25e-17", "1.7976e308", "4e-320", "123e000", "0.00000001", "10.5e1"};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        assert_near(good(numbers[k])->number, strtod(numbers[k], NULL), 0);
    for (int k = 0; k < 1000; k++) {
        char text[40];
        const double x = (k % 2 ? -1 : 1) * ldexp(1 + k / 1000.0, 7 * k % 2000 - 1000);
        snprintf(text, sizeof text, "%.17g", x);
        assert_near(good(text)->number, x, 0);
    }
    assert_string_equal(good("\"a\\\"\\\\\\/\\b\\f\\n\\r\\t\\u0041\\u007f\"")->string, "a\"\\/\b\f\n\r\tA\x7f");
}

static void members_are_found_by_name_and_kind(void **state)
{
    (void)state;
    const imp_json *root = good(" { \"a\" : [ 1 , [ ] , { } , \"x\" ] , \"b\" : null , \"c\" : 2.5 , \"d\" : true } ");
    assert_int_equal(root->count, 4);
    const imp_json *a = imp_json_get(root, "a", IMP_JSON_ARRAY);
    assert_non_null(a);
    assert_int_equal(a->count, 4);
    assert_null(imp_json_get(root, "a", IMP_JSON_OBJECT));
    assert_null(imp_json_get(root, "e", IMP_JSON_ARRAY));
    assert_null(imp_json_get(a, "a", IMP_JSON_ARRAY));
    assert_null(imp_json_get(NULL, "a", IMP_JSON_ARRAY));
    bool fine = true;
    assert_near(imp_json_number(root, "c", 9, &fine), 2.5, 0);
    assert_near(imp_json_number(root, "b", 9, &fine), 9, 0);
    assert_near(imp_json_number(root, "e", 9, &fine), 9, 0);
    assert_true(fine);
    assert_near(imp_json_number(root, "d", 9, &fine), 9, 0);
    assert_false(fine);
}

static void what_is_none_is_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {"",
                                        " ",
                                        "nul",
                                        "True",
                                        "1 2",
                                        "01",
                                        "-",
                                        "+1",
                                        ".5",
                                        "1.",
                                        "1e",
                                        "1e+",
                                        "1e999",
                                        "0x1",
                                        "NaN",
                                        "[1,]",
                                        "[,1]",
                                        "[1",
                                        "{\"a\":}",
                                        "{\"a\"}",
                                        "{a:1}",
                                        "{\"a\":1,}",
                                        "{1:1}",
                                        "\"a",
                                        "\"\n\"",
                                        "\"\\x\"",
                                        "\"\\u12\"",
                                        "\"\\u",
                                        "\"\\",
                                        "\"\\u0000\"",
                                        "\"\\u00e9\"",
                                        "\"\\u00g0\"",
                                        "[1 2]",
                                        "{\"a\":1 \"b\":2}",
                                        "]",
                                        "}",
                                        "1.2345678901234567890123456789012345678901234567890"};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) refused(texts[k], strlen(texts[k]));
    for (size_t depth = 20; depth <= 40; depth += 20) { /* 32 are allowed */
        char deep[81] = "";
        memset(deep, '[', depth);
        memset(deep + depth, ']', depth);
        if (depth < 32)
            assert_int_equal(good(deep)->kind, IMP_JSON_ARRAY);
        else
            refused(deep, 2 * depth);
    }
}

/* No proper beginning of an object is one. */
static void each_beginning_is_refused(void **state)
{
    (void)state;
    static const char whole[] = "{\"a\":[-1.5e-3,true,false,null,\"x\\u0041\\n\"],\"b\":{\"c\":{}},\"d\":[]}";
    good(whole);
    for (size_t size = 0; size + 1 < sizeof whole; size++) refused(whole, size);
}

static int open_arena(void **state)
{
    (void)state;
    return imp_arena_create(NULL, &arena) != IMPACT_OK;
}

static int close_arena(void **state)
{
    (void)state;
    imp_arena_destroy(arena);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_read), cmocka_unit_test(members_are_found_by_name_and_kind),
        cmocka_unit_test(what_is_none_is_refused), cmocka_unit_test(each_beginning_is_refused)};
    return cmocka_run_group_tests_name("impact.json", tests, open_arena, close_arena);
}
