/* SPDX-License-Identifier: MIT
 *
 * The page: fixed parts, a title that is escaped, and the record, deflated and in base64, which no byte of it can
 * leave.
 */
#include "view.h"
#include "deflate.h"

#include <impact/view.h>
#include <stdio.h>
#include <string.h>

#include "run/run_open.h"
#include "run/text.h"

/* The bytes of a page at most: what a browser takes without a pause. */
static const size_t largest_page = 20u << 20;

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

static impact_status too_large(const impact_run *run, size_t size, char *message, unsigned long message_size)
{
    if (message)
        snprintf(message, message_size,
                 "the page would have %.0f MB, and browsers take %.0f: record with a larger key_tolerance (now %g)",
                 1e-6 * (double)size, 1e-6 * (double)largest_page, impact_run_tolerance(run));
    return IMPACT_EARGUMENT;
}

static impact_status write_page(imp_arena *arena, const impact_run *run, const char *path, impact_quota *quota,
                                char *message, unsigned long message_size)
{
    size_t size;
    imp_text page = {.arena = arena}, packed = {.arena = arena};
    const void *bytes = impact_run_contents(run, &size);
    imp_deflate(&packed, bytes, size);
    imp_text_put(&page, imp_view_part_0, imp_view_size_0);
    put_title(&page, impact_run_name(run));
    imp_text_put(&page, imp_view_part_1, imp_view_size_1);
    if (!packed.failed) put_base64(&page, (const unsigned char *)packed.bytes, packed.size);
    imp_text_put(&page, imp_view_part_2, imp_view_size_2);
    if (page.size > largest_page) return too_large(run, page.size, message, message_size);
    if (!page.failed && !packed.failed)
        return imp_file_save(arena, path, page.bytes, page.size, quota, message, message_size);
    if (message) imp_arena_explain(run->arena, message, message_size);
    return IMPACT_ENOMEM;
}

impact_status impact_view_write(const impact_run *run, const char *path, impact_quota *quota, char *message,
                                unsigned long message_size)
{
    imp_arena *arena;
    const impact_allocator within = imp_arena_allocator(run->arena);
    impact_status status = imp_arena_create(&within, &arena);
    if (status == IMPACT_OK)
        status = write_page(arena, run, path, quota, message, message_size);
    else if (message)
        imp_arena_explain(run->arena, message, message_size);
    imp_arena_destroy(arena);
    return status;
}
