/* SPDX-License-Identifier: MIT
 *
 * CSV files: every bit comes back, nothing stands under its final name before it is whole, and what fails says so.
 */
#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <impact/scene.h>
#include "kit/contact_random.h"
#include "kit/ledger.h"

static char folder[] = "record_XXXXXX";
static char samples_path[64], events_path[64], samples_part[72], events_part[72];
static char samples_partial[72], events_partial[72];

/* Whether files that are not whole have a name: test_record_named.c. */
#if !defined(NAMED)
#define NAMED false
#endif

static int make_folder(void **state)
{
    (void)state;
    if (!mkdtemp(folder)) return -1;
    snprintf(samples_path, sizeof samples_path, "%s/samples.csv", folder);
    snprintf(events_path, sizeof events_path, "%s/events.csv", folder);
    snprintf(samples_part, sizeof samples_part, "%s.part", samples_path);
    snprintf(events_part, sizeof events_part, "%s.part", events_path);
    snprintf(samples_partial, sizeof samples_partial, "%s/samples.partial.csv", folder);
    snprintf(events_partial, sizeof events_partial, "%s/events.partial.csv", folder);
    return 0;
}

static int clear_folder(void **state)
{
    (void)state;
    remove(samples_path), remove(events_path), remove(samples_part), remove(events_part);
    remove(samples_partial), remove(events_partial);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    return rmdir(folder); /* fails when a test left something */
}

static bool exists(const char *path)
{
    struct stat status;
    return lstat(path, &status) == 0;
}

static impact_csv *open_csv(void)
{
    char message[256] = "";
    impact_csv *csv;
    if (impact_csv_open(samples_path, events_path, &csv, message, sizeof message) != IMPACT_OK) fail_msg("%s", message);
    return csv;
}

static void keep_csv(impact_csv *csv)
{
    char message[256] = "";
    if (impact_csv_close(csv, IMPACT_CSV_KEEP, message, sizeof message) != IMPACT_OK) fail_msg("%s", message);
}

/* The whole file; free it. */
static char *read_whole(const char *path)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    char *text = calloc(1, 1 << 22);
    assert_true(fread(text, 1, (1 << 22) - 1, file) < (1 << 22) - 1);
    fclose(file);
    return text;
}

/* A field of RFC 4180 into word; past its comma or line end. */
static const char *read_field(const char *text, char *word)
{
    if (*text == '"') {
        for (text++; *text != '"' || text[1] == '"'; text++) {
            assert_true(*text != '\0');
            if (*text == '"') text++;
            *word++ = *text;
        }
        text++;
    } else {
        while (*text != ',' && *text != '\n') *word++ = *text++;
    }
    *word = '\0';
    assert_true(*text == ',' || *text == '\n');
    return text + 1;
}

static const char *expect_word(const char *text, const char *wanted)
{
    char word[256];
    text = read_field(text, word);
    assert_string_equal(word, wanted);
    return text;
}

/* Bit for bit, but that -0 is written as 0. */
static const char *expect_number(const char *text, double wanted)
{
    char word[256], *end;
    text = read_field(text, word);
    const double got = strtod(word, &end);
    assert_true(*end == '\0' && word[0] != '\0' && word[0] != ' ');
    wanted += 0.0;
    assert_memory_equal(&got, &wanted, sizeof got);
    return text;
}

static const char *expect_numbers(const char *text, const double *wanted, int count)
{
    for (int i = 0; i < count; i++) text = expect_number(text, wanted[i]);
    return text;
}

static const char *skip_header(const char *text, const char *wanted)
{
    const size_t length = strlen(wanted);
    assert_memory_equal(text, wanted, length);
    return text + length;
}

static const char samples_header[] = "t,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
static const char events_header[] =
    "t,event,body1,body2,px,py,pz,nx,ny,nz,impulse_n,impulse_t,un_before,un_after,phases,"
    "encounter,energy_before,energy_after\n";

/* Any finite double; now and then one of the ends of their range. */
static double any_double(random_stream *random)
{
    static const double ends[] = {0,   -0.0, 0x1p-1074, -0x1p-1022, 1.7976931348623157e308, -1.7976931348623157e308,
                                  0.1, 1e23};
    if (random_bits(random) % 8 == 0) return ends[random_bits(random) % (sizeof ends / sizeof *ends)];
    for (;;) {
        const uint64_t bits = random_bits(random);
        double value;
        memcpy(&value, &bits, sizeof value);
        if (isfinite(value)) return value;
    }
}

static qvec3 any_vector(random_stream *random)
{
    return (qvec3){any_double(random), any_double(random), any_double(random)};
}

static const char *const names[] = {"ball", "a,b",          "say \"hi\"", "two\nlines", "\"",
                                    ",",    "kula på golv", "cr\rlf",     " blank "};

static impact_sample any_sample(random_stream *random)
{
    return (impact_sample){any_double(random),
                           0,
                           names[random_bits(random) % (sizeof names / sizeof *names)],
                           any_vector(random),
                           {any_double(random), any_double(random), any_double(random), any_double(random)},
                           any_vector(random),
                           any_vector(random)};
}

static impact_event any_event(random_stream *random)
{
    return (impact_event){.t = any_double(random),
                          .kind = (impact_event_kind)(random_bits(random) % (IMPACT_EVENT_REST + 1)),
                          .body2 = -1,
                          .name1 = names[random_bits(random) % (sizeof names / sizeof *names)],
                          .name2 = random_bits(random) & 1 ? "" : names[1],
                          .point = any_vector(random),
                          .normal = any_vector(random),
                          .impulse_normal = any_double(random),
                          .impulse_tangential = any_double(random),
                          .normal_before = any_double(random),
                          .normal_after = any_double(random),
                          .encounter = (long)(random_bits(random) % 1000),
                          .phases = random_bits(random) & 1 ? "" : "slip-c stick-c stick-r",
                          .energy_before = any_double(random),
                          .energy_after = any_double(random)};
}

static void check_sample_row(const char **text, const impact_sample *s)
{
    const double values[13] = {s->position.x,    s->position.y,    s->position.z, s->orientation.w, s->orientation.x,
                               s->orientation.y, s->orientation.z, s->velocity.x, s->velocity.y,    s->velocity.z,
                               s->omega.x,       s->omega.y,       s->omega.z};
    *text = expect_numbers(expect_word(expect_number(*text, s->t), s->name), values, 13);
    assert_true((*text)[-1] == '\n');
}

static void check_event_row(const char **text, const impact_event *e)
{
    const double values[10] = {e->point.x,       e->point.y,     e->point.z,        e->normal.x,
                               e->normal.y,      e->normal.z,    e->impulse_normal, e->impulse_tangential,
                               e->normal_before, e->normal_after};
    const char *row = expect_word(expect_number(*text, e->t), impact_event_name(e->kind));
    row = expect_numbers(expect_word(expect_word(row, e->name1), e->name2), values, 10);
    row = expect_number(expect_word(row, e->phases), (double)e->encounter);
    row = expect_number(expect_number(row, e->energy_before), e->energy_after);
    assert_true(row[-1] == '\n');
    *text = row;
}

static void write_rows(impact_csv *csv, int rows)
{
    const impact_recorder recorder = impact_csv_recorder(csv);
    assert_null(recorder.progress);
    random_stream random = {7};
    for (int i = 0; i < rows; i++) {
        const impact_sample sample = any_sample(&random);
        const impact_event event = any_event(&random);
        assert_true(recorder.sample(recorder.context, &sample));
        assert_true(recorder.event(recorder.context, &event));
    }
}

static void check_rows(int rows)
{
    char *samples = read_whole(samples_path), *events = read_whole(events_path);
    const char *s = skip_header(samples, samples_header), *e = skip_header(events, events_header);
    random_stream random = {7};
    for (int i = 0; i < rows; i++) {
        const impact_sample sample = any_sample(&random);
        const impact_event event = any_event(&random);
        check_sample_row(&s, &sample);
        check_event_row(&e, &event);
    }
    assert_true(*s == '\0' && *e == '\0');
    free(samples);
    free(events);
}

static void every_bit_comes_back(void **state)
{
    (void)state;
    impact_csv *csv = open_csv();
    write_rows(csv, 3000);
    assert_true(exists(samples_part) == NAMED && exists(events_part) == NAMED);
    assert_true(!exists(samples_path) && !exists(events_path));
    keep_csv(csv);
    assert_true(!exists(samples_part) && !exists(events_part));
    check_rows(3000);
}

/* A comma for a decimal point, where such a locale is installed. */
static void a_decimal_comma_changes_nothing(void **state)
{
    (void)state;
    static const char *const locales[] = {"sv_SE.utf8", "de_DE.utf8", "fr_FR.utf8", "sv_SE",
                                          "de_DE",      "fr_FR",      "ps_AF.utf8"};
    bool any = false;
    for (size_t i = 0; i < sizeof locales / sizeof *locales; i++) {
        if (!setlocale(LC_NUMERIC, locales[i])) continue;
        any = true;
        impact_csv *csv = open_csv();
        write_rows(csv, 50);
        keep_csv(csv);
        setlocale(LC_NUMERIC, "C");
        check_rows(50);
    }
    if (!any) skip();
}

static void discarded_files_are_gone(void **state)
{
    (void)state;
    FILE *old = fopen(samples_path, "w");
    assert_non_null(old);
    fputs("of the last run\n", old);
    fclose(old);
    impact_csv *csv = open_csv();
    write_rows(csv, 100);
    assert_int_equal(impact_csv_close(csv, IMPACT_CSV_DROP, NULL, 0), IMPACT_OK);
    assert_true(!exists(samples_part) && !exists(events_part) && !exists(events_path));
    char *text = read_whole(samples_path);
    assert_string_equal(text, "of the last run\n");
    free(text);
    assert_int_equal(impact_csv_close(NULL, IMPACT_CSV_KEEP, NULL, 0), IMPACT_OK);
}

static void either_file_may_be_left_out(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        impact_csv *csv;
        assert_int_equal(impact_csv_open(k & 1 ? samples_path : NULL, k & 2 ? events_path : NULL, &csv, NULL, 0),
                         IMPACT_OK);
        write_rows(csv, 3);
        keep_csv(csv);
        assert_true(exists(samples_path) == ((k & 1) != 0) && exists(events_path) == ((k & 2) != 0));
        clear_folder(NULL);
    }
}

static void expect_open_to_fail(const char *samples, const char *events, impact_status wanted, const char *names_this)
{
    char message[256] = "";
    impact_csv *csv = (impact_csv *)message;
    assert_int_equal(impact_csv_open(samples, events, &csv, message, sizeof message), wanted);
    assert_null(csv);
    assert_non_null(strstr(message, names_this));
    assert_int_equal(impact_csv_open(samples, events, &csv, NULL, 0), wanted);
    assert_true(!exists(samples_part) && !exists(events_part));
}

static void unwritable_paths_are_named(void **state)
{
    (void)state;
    FILE *file = fopen(samples_path, "w");
    assert_non_null(file);
    fclose(file);
    char below[80], nowhere[80];
    snprintf(below, sizeof below, "%s/x.csv", samples_path);
    snprintf(nowhere, sizeof nowhere, "%s/no/such/folder.csv", folder);
    expect_open_to_fail(below, NULL, IMPACT_ESINK, below);
    expect_open_to_fail(below, NULL, IMPACT_ESINK, strerror(ENOTDIR));
    expect_open_to_fail(events_path, below, IMPACT_ESINK, below);
    expect_open_to_fail(nowhere, events_path, IMPACT_ESINK, strerror(ENOENT));
    expect_open_to_fail(events_path, events_path, IMPACT_EARGUMENT, events_path); /* both into one file */
}

/* A folder that has taken the final name: found when the run is over. */
static void a_taken_name_is_found_at_the_end(void **state)
{
    (void)state;
    impact_csv *csv = open_csv();
    write_rows(csv, 3);
    assert_int_equal(mkdir(events_path, 0700), 0);
    char message[256] = "";
    assert_int_equal(impact_csv_close(csv, IMPACT_CSV_KEEP, message, sizeof message), IMPACT_ESINK);
    assert_non_null(strstr(message, events_path));
    assert_true(!exists(samples_part) && !exists(events_part));
    assert_int_equal(rmdir(events_path), 0);
}

/* A disk with room for so many bytes in a file, from here on. */
static void limit_files(rlim_t bytes)
{
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    limit.rlim_cur = bytes;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    signal(SIGXFSZ, SIG_IGN);
}

static bool write_events(impact_csv *csv, int rows)
{
    const impact_recorder recorder = impact_csv_recorder(csv);
    random_stream random = {7};
    for (int i = 0; i < rows; i++) {
        const impact_event event = any_event(&random);
        if (!recorder.event(recorder.context, &event)) return false;
    }
    return true;
}

static void a_full_disk_is_told(void **state)
{
    (void)state;
    for (int rows = 2; rows <= 2000; rows += 1998) {
        impact_csv *csv = open_csv();
        limit_files(100);
        assert_true(write_events(csv, rows) == (rows == 2)); /* few rows are still in the buffer */
        char message[256] = "";
        assert_int_equal(impact_csv_close(csv, IMPACT_CSV_KEEP, message, sizeof message), IMPACT_ESINK);
        limit_files(RLIM_INFINITY);
        assert_non_null(strstr(message, events_path));
        assert_non_null(strstr(message, strerror(EFBIG)));
        assert_true(!exists(samples_part) && !exists(events_part) && !exists(samples_path) && !exists(events_path));
    }
}

static int count_lines(const char *path)
{
    char *text = read_whole(path);
    int lines = 0;
    for (const char *c = text; *c; c++) lines += *c == '\n';
    assert_true(*text && text[strlen(text) - 1] == '\n');
    free(text);
    return lines;
}

/* What a full disk holds of it stays, to the end of a line. */
static void what_ended_early_is_kept_as_such(void **state)
{
    (void)state;
    for (int room = 0; room < 3; room++) {
        impact_csv *csv = open_csv();
        if (room < 2) limit_files(room ? 30000 : 100000);
        const bool all = write_events(csv, 2000);
        assert_true(all == (room == 2));
        assert_true(impact_csv_rows(csv) > 0);
        assert_int_equal(impact_csv_close(csv, IMPACT_CSV_PARTIAL, NULL, 0), IMPACT_OK);
        limit_files(RLIM_INFINITY);
        assert_true(!exists(samples_part) && !exists(events_part) && !exists(samples_path) && !exists(events_path));
        assert_int_equal(count_lines(samples_partial), 1);
        const int lines = count_lines(events_partial);
        assert_true(room == 2 ? lines >= 2001 : lines > (room ? 50 : 200) && lines < 1000);
    }
    impact_csv *csv = open_csv(); /* a whole run after it */
    keep_csv(csv);
    assert_true(!exists(samples_partial) && !exists(events_partial) && exists(samples_path) && exists(events_path));
    clear_folder(NULL);
    csv = open_csv(); /* and one that has no row yet */
    assert_int_equal(impact_csv_close(csv, IMPACT_CSV_PARTIAL, NULL, 0), IMPACT_OK);
    assert_true(!exists(samples_partial) && !exists(events_partial));
}

static void a_quota_binds_both_files_together(void **state)
{
    (void)state;
    impact_quota quota = {.left = 5000};
    const impact_csv_def def = {
        .struct_size = sizeof def, .samples_path = samples_path, .events_path = events_path, .quota = &quota};
    impact_csv *csv;
    assert_int_equal(impact_csv_open_with(&def, &csv, NULL, 0), IMPACT_OK);
    assert_false(write_events(csv, 100));
    assert_int_equal(errno, EDQUOT);
    assert_true(quota.spent && quota.left < 500);
    assert_int_equal(impact_csv_close(csv, IMPACT_CSV_PARTIAL, NULL, 0), IMPACT_OK);
    struct stat samples, events;
    assert_int_equal(stat(samples_partial, &samples), 0);
    assert_int_equal(stat(events_partial, &events), 0);
    assert_true(samples.st_size + events.st_size + (off_t)quota.left <= 5000);
    count_lines(events_partial);
}

/* All memory but the C library's FILE is the caller's, and its refusals are answered. */
static void memory_is_the_callers(void **state)
{
    (void)state;
    ledger l = {0};
    for (long fail_at = 0; fail_at <= 6; fail_at++) {
        l = (ledger){.fail_at = fail_at};
        const impact_allocator allocator = ledger_allocator(&l, 0);
        const impact_csv_def def = {.struct_size = sizeof def,
                                    .samples_path = samples_path,
                                    .events_path = events_path,
                                    .allocator = &allocator};
        impact_csv *csv;
        const impact_status status = impact_csv_open_with(&def, &csv, NULL, 0);
        assert_true(status == IMPACT_OK || ((status == IMPACT_ENOMEM || status == IMPACT_ESINK) && !csv));
        if (csv) write_rows(csv, 100);
        assert_int_equal(impact_csv_close(csv, IMPACT_CSV_DROP, NULL, 0), IMPACT_OK);
        assert_int_equal(l.live, 0);
        assert_true(!exists(samples_part) && !exists(events_part));
    }
}

/* What a spreadsheet would run is text for it, and can be told from what was text before. */
static void no_cell_is_a_formula(void **state)
{
    (void)state;
    static const char *const cells[][2] = {{"=1+1", "'=1+1"},         {"+a", "'+a"},   {"-a", "'-a"},
                                           {"@SUM(A1)", "'@SUM(A1)"}, {"\tx", "'\tx"}, {"\rx", "'\rx"},
                                           {"'=a", "''=a"},           {"a=1", "a=1"},  {"=\"x\",y", "'=\"x\",y"}};
    for (size_t i = 0; i < sizeof cells / sizeof *cells; i++) {
        impact_csv *csv = open_csv();
        const impact_recorder recorder = impact_csv_recorder(csv);
        const impact_sample sample = {.name = cells[i][0]};
        assert_true(recorder.sample(recorder.context, &sample));
        keep_csv(csv);
        char *text = read_whole(samples_path);
        expect_word(expect_number(skip_header(text, samples_header), 0), cells[i][1]);
        free(text);
    }
}

static impact_scene *make_drop(void)
{
    static impact_body_def bodies[2];
    bodies[0] = bodies[1] = impact_default_body_def();
    bodies[0].name = "floor";
    bodies[0].is_static = true;
    impact_shape_plane(INFINITY, INFINITY, &bodies[0].shape);
    bodies[1].name = "ball";
    bodies[1].position = (qvec3){0, 0, 1};
    bodies[1].restitution = 0.8;
    bodies[0].restitution = 1;
    impact_shape_sphere(0.1, &bodies[1].shape);
    impact_scene_def def = impact_default_scene_def();
    def.bodies = bodies;
    def.body_count = 2;
    def.duration = 1;
    def.output_rate = 1000;
    impact_scene *scene;
    assert_int_equal(impact_scene_create(&def, &scene, NULL, 0), IMPACT_OK);
    return scene;
}

static void a_run_is_recorded_whole_or_not_at_all(void **state)
{
    (void)state;
    impact_scene *scene = make_drop();
    impact_csv *csv = open_csv();
    impact_recorder recorder = impact_csv_recorder(csv);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_OK);
    const impact_usage usage = impact_scene_usage(scene);
    keep_csv(csv);
    impact_scene_destroy(scene);
    assert_int_equal(count_lines(samples_path), 1 + usage.samples);
    assert_int_equal(count_lines(events_path), 1 + usage.events[IMPACT_EVENT_IMPACT]);
    clear_folder(NULL);
    scene = make_drop();
    csv = open_csv();
    limit_files(1000);
    recorder = impact_csv_recorder(csv);
    assert_int_equal(impact_scene_run(scene, &recorder), IMPACT_ESINK);
    assert_true(impact_scene_time(scene) < 1);
    assert_int_equal(impact_csv_close(csv, IMPACT_CSV_DROP, NULL, 0), IMPACT_OK);
    limit_files(RLIM_INFINITY);
    assert_true(!exists(samples_part) && !exists(samples_path) && !exists(events_path));
    impact_scene_destroy(scene);
}

static void every_event_has_a_word(void **state)
{
    (void)state;
    static const char *const words[] = {"impact", "contact", "slip", "stick", "liftoff", "force", "rest"};
    for (int kind = IMPACT_EVENT_IMPACT; kind <= IMPACT_EVENT_REST; kind++)
        assert_string_equal(impact_event_name((impact_event_kind)kind), words[kind]);
    assert_string_equal(impact_event_name((impact_event_kind)99), "unknown");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(every_bit_comes_back, clear_folder),
        cmocka_unit_test_teardown(a_decimal_comma_changes_nothing, clear_folder),
        cmocka_unit_test_teardown(discarded_files_are_gone, clear_folder),
        cmocka_unit_test_teardown(either_file_may_be_left_out, clear_folder),
        cmocka_unit_test_teardown(unwritable_paths_are_named, clear_folder),
        cmocka_unit_test_teardown(a_taken_name_is_found_at_the_end, clear_folder),
        cmocka_unit_test_teardown(a_full_disk_is_told, clear_folder),
        cmocka_unit_test_teardown(a_run_is_recorded_whole_or_not_at_all, clear_folder),
        cmocka_unit_test_teardown(what_ended_early_is_kept_as_such, clear_folder),
        cmocka_unit_test_teardown(a_quota_binds_both_files_together, clear_folder),
        cmocka_unit_test_teardown(memory_is_the_callers, clear_folder),
        cmocka_unit_test_teardown(no_cell_is_a_formula, clear_folder),
        cmocka_unit_test(every_event_has_a_word),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
