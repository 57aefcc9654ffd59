/* SPDX-License-Identifier: MIT
 *
 * The bodies' names: each finds its number, and no other does; as a search through all of them would have it.
 */
#include "scene/names.h"
#include "kit/contact_random.h"
#include "kit/near.h"

#include <stdio.h>
#include <string.h>

enum { MOST = 3000 };

static int search(char (*names)[12], int count, const char *name)
{
    for (int i = 0; i < count; i++)
        if (strcmp(names[i], name) == 0) return i;
    return -1;
}

/* Words of few letters, so that most have been there before. */
static void random_name(random_stream *random, char *name)
{
    const int length = 1 + (int)(6 * random_unit(random));
    for (int k = 0; k < length; k++) name[k] = (char)('a' + (int)(3 * random_unit(random)));
    name[length] = '\0';
}

static void each_name_has_its_number(void **state)
{
    (void)state;
    static char known[MOST][12];
    random_stream random = {1};
    imp_arena *arena;
    imp_names names;
    assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
    assert_int_equal(imp_names_open(&names, arena, MOST), IMPACT_OK);
    int count = 0, met = 0;
    for (int i = 0; i < MOST; i++) {
        char name[12];
        random_name(&random, name);
        const int found = imp_names_find(&names, name);
        assert_int_equal(found, search(known, count, name));
        met += found >= 0;
        if (found >= 0) continue;
        assert_int_equal(imp_names_add(&names, name), IMPACT_OK);
        strcpy(known[count++], name);
    }
    assert_true(met > 100 && count > 100);
    for (int i = 0; i < count; i++) {
        assert_int_equal(imp_names_find(&names, known[i]), i);
        assert_string_equal(names.names[i], known[i]);
    }
    assert_int_equal(imp_names_find(&names, NULL), -1);
    assert_int_equal(imp_names_find(&names, ""), -1);
    imp_arena_destroy(arena);
}

/* As many as there is room for: the table still has empty places, so that a search for what is not there ends. */
static void a_full_table_still_ends_every_search(void **state)
{
    (void)state;
    imp_arena *arena;
    assert_int_equal(imp_arena_create(NULL, &arena), IMPACT_OK);
    for (int room = 1; room < 70; room++) {
        imp_names names;
        assert_int_equal(imp_names_open(&names, arena, room), IMPACT_OK);
        for (int i = 0; i < room; i++) {
            char name[12];
            snprintf(name, sizeof name, "%d", i);
            assert_int_equal(imp_names_add(&names, name), IMPACT_OK);
        }
        assert_int_equal(imp_names_find(&names, "stranger"), -1);
        assert_int_equal(imp_names_find(&names, "0"), 0);
    }
    imp_arena_destroy(arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_name_has_its_number),
                                       cmocka_unit_test(a_full_table_still_ends_every_search)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
