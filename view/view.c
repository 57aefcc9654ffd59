/* SPDX-License-Identifier: MIT
 *
 * The page: fixed parts, a title that is escaped, and the scripts and the record, deflated and in base64, which no byte
 * of them can leave.
 */
#include "view.h"
#include "deflate.h"
#include "plain.h"
#include "thin.h"

#include <impact/view.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "run/run_open.h"
#include "run/text.h"

/* Bytes of a page: more than this is thinned; more than that no browser takes without a pause. */
static const size_t pleasant_page = 900000, largest_page = 20u << 20;

static void put_title(imp_text *page, const char *name)
{
    for (const char *c = name; *c; c++) {
        char escape[16];
        const bool plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9') ||
                           strchr(" _.,-", *c) || (unsigned char)*c >= 0x80;
        if (plain)
            imp_text_put(page, c, 1);
        else if ((unsigned char)*c >= 0x20) {
            snprintf(escape, sizeof escape, "&#%d;", *c);
            imp_text_say(page, escape);
        }
    }
}

static void put_base64(imp_text *page, const unsigned char *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        const unsigned long left = size - i;
        const unsigned long three = ((unsigned long)bytes[i] << 16) |
                                    (left > 1 ? (unsigned long)bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
        const char four[4] = {digits[three >> 18], digits[three >> 12 & 63], left > 1 ? digits[three >> 6 & 63] : '=',
                              left > 2 ? digits[three & 63] : '='};
        imp_text_put(page, four, 4);
    }
}

static impact_status out_of_memory(const impact_run *run, char *message, unsigned long message_size)
{
    if (message) imp_arena_explain(run->arena, message, message_size);
    return IMPACT_ENOMEM;
}

/* Scripts and record are packed as one. */
static impact_status make_page(imp_text *page, const impact_run *run, const void *record, size_t size)
{
    imp_text plain = {.arena = page->arena}, packed = {.arena = page->arena};
    imp_text_put(&plain, imp_view_script, imp_view_script_size);
    imp_text_put(&plain, "", 1);
    imp_text_put(&plain, record, size);
    if (!plain.failed) imp_deflate(&packed, (const unsigned char *)plain.bytes, plain.size);
    imp_text_free(&plain);
    imp_text_put(page, imp_view_part_0, imp_view_size_0);
    put_title(page, impact_run_name(run));
    imp_text_put(page, imp_view_part_1, imp_view_size_1);
    if (!plain.failed && !packed.failed) put_base64(page, (const unsigned char *)packed.bytes, packed.size);
    imp_text_put(page, imp_view_part_2, imp_view_size_2);
    const bool failed = page->failed || plain.failed || packed.failed;
    imp_text_free(&packed);
    return failed ? IMPACT_ENOMEM : IMPACT_OK;
}

static impact_status make_thin_page(imp_text *page, const impact_run *run, double tolerance)
{
    imp_text thin = {.arena = page->arena};
    impact_status status = imp_thin(&thin, run, tolerance);
    imp_text_free(page);
    if (status == IMPACT_OK) status = make_page(page, run, thin.bytes, thin.size);
    imp_text_free(&thin);
    return status;
}

/* Says by what tolerance it would fit, if by any. */
static impact_status too_large(imp_text *page, const impact_run *run, double tolerance, char *message,
                               unsigned long message_size)
{
    const double size = 1e-6 * (double)page->size, most = 1e-6 * (double)largest_page;
    impact_status status = IMPACT_OK;
    double fits = tolerance;
    while (status == IMPACT_OK && page->size > largest_page && fits < IMP_THIN_MOST) {
        fits = fmin(10 * fits, IMP_THIN_MOST);
        status = make_thin_page(page, run, fits);
    }
    if (status != IMPACT_OK) return out_of_memory(run, message, message_size);
    char advice[60] = "and no tolerance changes that";
    if (page->size <= largest_page) snprintf(advice, sizeof advice, "a tolerance of %g would do", fits);
    if (message)
        snprintf(message, message_size, "the page would have %.0f MB at a tolerance of %g, and browsers take %.0f: %s",
                 size, tolerance, most, advice);
    return IMPACT_EARGUMENT;
}

static impact_status write_page(imp_arena *arena, const impact_run *run, double tolerance, const char *path,
                                impact_quota *quota, char *message, unsigned long message_size)
{
    size_t size;
    bool changed;
    impact_run plain;
    imp_text page = {.arena = arena}, whole = {.arena = arena};
    const void *bytes = impact_run_contents(run, &size);
    impact_status status = imp_plain(arena, run, &plain, &changed);
    if (status == IMPACT_OK && changed) status = imp_thin(&whole, &plain, 0), bytes = whole.bytes, size = whole.size;
    if (status == IMPACT_OK) status = make_page(&page, run, bytes, size);
    imp_text_free(&whole);
    run = &plain;
    if (status == IMPACT_OK && page.size > pleasant_page) status = make_thin_page(&page, run, tolerance);
    if (status != IMPACT_OK) return out_of_memory(run, message, message_size);
    if (page.size > largest_page) return too_large(&page, run, tolerance, message, message_size);
    return imp_file_save(arena, path, page.bytes, page.size, quota, message, message_size);
}

impact_status impact_view_write(const impact_run *run, double tolerance, const char *path, impact_quota *quota,
                                char *message, unsigned long message_size)
{
    if (!(tolerance >= IMP_THIN_LEAST && tolerance <= IMP_THIN_MOST)) {
        if (message)
            snprintf(message, message_size, "tolerance must lie in [%g, %g], got %g", IMP_THIN_LEAST, IMP_THIN_MOST,
                     tolerance);
        return IMPACT_EARGUMENT;
    }
    imp_arena *arena;
    const impact_allocator within = imp_arena_allocator(run->arena);
    impact_status status = imp_arena_create(&within, &arena);
    if (status == IMPACT_OK)
        status = write_page(arena, run, tolerance, path, quota, message, message_size);
    else if (message)
        imp_arena_explain(run->arena, message, message_size);
    imp_arena_destroy(arena);
    return status;
}
