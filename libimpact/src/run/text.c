/* SPDX-License-Identifier: MIT */
#include "run/text.h"
#include "base/number.h"
#include "base/tolerances.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void imp_text_free(imp_text *text)
{
    imp_arena_give(text->arena, text->bytes);
    *text = (imp_text){.arena = text->arena};
}

/* Room for so many bytes, doubled where it grows; false when there is none. */
static bool make_room(imp_text *text, size_t wanted)
{
    const size_t doubled = 2 * (size_t)text->room, room = wanted > doubled ? wanted : doubled;
    if (wanted > INT_MAX / 2) return false;
    char *more = imp_arena_take_unset(text->arena, room, 1);
    if (!more) return false;
    if (text->size > 0) memcpy(more, text->bytes, text->size);
    imp_arena_give(text->arena, text->bytes);
    text->bytes = more;
    text->room = (int)room;
    return true;
}

char *imp_text_room(imp_text *text, size_t size)
{
    if (text->failed) return NULL;
    if (text->size + size > (size_t)text->room) text->failed = !make_room(text, text->size + size);
    if (text->failed) return NULL;
    text->size += size;
    return text->bytes + text->size - size;
}

void imp_text_put(imp_text *text, const void *bytes, size_t size)
{
    char *out = imp_text_room(text, size);
    if (out && size > 0) memcpy(out, bytes, size);
}

void imp_text_say(imp_text *text, const char *words) { imp_text_put(text, words, strlen(words)); }

/* Whole numbers, which most of a head's are, digit by digit from the last. */
static void say_whole(imp_text *text, long long value)
{
    char word[24], *digit = word + sizeof word;
    unsigned long long rest = (unsigned long long)(value < 0 ? -value : value);
    do *--digit = (char)('0' + rest % 10);
    while ((rest /= 10) > 0);
    if (value < 0) *--digit = '-';
    imp_text_put(text, digit, (size_t)(word + sizeof word - digit));
}

/* The shortest of 15, 16 and 17 digits that gives back the same bits. */
void imp_text_number(imp_text *text, double value)
{
    if (fabs(value) < IMP_MOST_WHOLE && value == trunc(value) && !(value == 0 && signbit(value))) {
        say_whole(text, (long long)value);
        return;
    }
    if (!isfinite(value)) {
        imp_text_say(text, "null");
        return;
    }
    imp_text_say(text, imp_number_of(value).text);
}

void imp_text_string(imp_text *text, const char *string)
{
    imp_text_say(text, "\"");
    for (const char *c = string; *c; c++) {
        char escape[8];
        if ((unsigned char)*c >= 0x20 && *c != '"' && *c != '\\' && *c != '<' && *c != 0x7f) {
            imp_text_put(text, c, 1);
            continue;
        }
        snprintf(escape, sizeof escape, "\\u%04x", (unsigned)(unsigned char)*c);
        imp_text_say(text, escape);
    }
    imp_text_say(text, "\"");
}
