/* SPDX-License-Identifier: MIT
 *
 * Every value takes a byte of the text at least, and every string no more bytes than its text has: the size of the
 * text bounds both arrays, which are made once.
 */
#include "run/json.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 32 };

typedef struct scanner {
    const char *at, *end;
    imp_json *nodes;
    size_t used;
    char *strings;
} scanner;

static void skip_blanks(scanner *r)
{
    while (r->at < r->end && strchr(" \t\r\n", *r->at) && *r->at) r->at++;
}

/* Takes the character when it is next. */
static bool take(scanner *r, char c)
{
    if (r->at == r->end || *r->at != c) return false;
    r->at++;
    return true;
}

static bool take_word(scanner *r, const char *word)
{
    const size_t size = strlen(word);
    if ((size_t)(r->end - r->at) < size || memcmp(r->at, word, size) != 0) return false;
    r->at += size;
    return true;
}

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

static const char *skip_digits(const char *at, const char *end)
{
    while (at < end && is_digit(*at)) at++;
    return at;
}

/* Digits as a whole number, then a power of ten: strtod would ask the locale for the decimal point. The text's form is
 * checked here; its value is left to strtod of a copy with no point: d digits after it are 10^-d. */
static bool read_number(scanner *r, double *value)
{
    char copy[64];
    size_t used = 0;
    long shift = 0;
    const char *at = r->at;
    if (at < r->end && *at == '-') at++;
    const char *whole = at;
    at = skip_digits(at, r->end);
    if (at == whole || (at - whole > 1 && *whole == '0')) return false;
    const char *fraction = at < r->end && *at == '.' ? at + 1 : NULL;
    if (fraction) {
        at = skip_digits(fraction, r->end);
        if (at == fraction) return false;
        shift = (long)(at - fraction);
    }
    const char *mantissa_end = at;
    long exponent = 0;
    if (at < r->end && (*at == 'e' || *at == 'E')) {
        const bool negative = ++at < r->end && *at == '-';
        if (at < r->end && (*at == '-' || *at == '+')) at++;
        const char *digits = at;
        for (; at < r->end && is_digit(*at); at++)
            exponent = exponent < 100000 ? 10 * exponent + (*at - '0') : exponent;
        if (at == digits) return false;
        if (negative) exponent = -exponent;
    }
    if (mantissa_end - r->at > 40) return false; /* no number of ours is so long */
    for (const char *c = r->at; c < mantissa_end; c++)
        if (*c != '.') copy[used++] = *c;
    copy[used++] = 'e';
    exponent -= shift;
    if (exponent < 0) copy[used++] = '-';
    char reversed[24];
    size_t places = 0;
    for (unsigned long n = (unsigned long)labs(exponent); places == 0 || n > 0; n /= 10)
        reversed[places++] = (char)('0' + n % 10);
    while (places > 0) copy[used++] = reversed[--places];
    copy[used] = '\0';
    *value = strtod(copy, NULL);
    r->at = at;
    return isfinite(*value);
}

static int hex(char c)
{
    return is_digit(c) ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* The four digits of \uXXXX; -1: they are none. */
static int read_unit(scanner *r)
{
    int unit = 0;
    if (r->end - r->at < 4) return -1;
    for (int i = 0; i < 4; i++, r->at++) {
        const int digit = hex(*r->at);
        if (digit < 0) return -1;
        unit = 16 * unit + digit;
    }
    return unit;
}

/* One byte stands for itself: the writer escapes bytes, and leaves the rest of UTF-8 as it is. */
static bool read_escape(scanner *r)
{
    static const char from[] = "\"\\/bfnrt", to[] = "\"\\/\b\f\n\r\t";
    if (r->at == r->end) return false;
    const char c = *r->at++;
    const char *place = c ? strchr(from, c) : NULL;
    if (place) {
        *r->strings++ = to[place - from];
        return true;
    }
    const int unit = c == 'u' ? read_unit(r) : -1;
    if (unit <= 0 || unit > 0x7f) return false;
    *r->strings++ = (char)unit;
    return true;
}

static const char *read_string(scanner *r)
{
    const char *begin = r->strings;
    if (!take(r, '"')) return NULL;
    while (r->at < r->end && *r->at != '"') {
        if ((unsigned char)*r->at < 0x20) return NULL;
        if (*r->at != '\\')
            *r->strings++ = *r->at++;
        else if (r->at++, !read_escape(r))
            return NULL;
    }
    *r->strings++ = '\0';
    return take(r, '"') ? begin : NULL;
}

static imp_json *read_value(scanner *r, int depth);

/* The members of an array or object, whose bracket is taken. */
static bool read_members(scanner *r, imp_json *node, char close, int depth)
{
    const imp_json **link = &node->first;
    skip_blanks(r);
    if (take(r, close)) return true;
    do {
        const char *key = NULL;
        skip_blanks(r);
        if (node->kind == IMP_JSON_OBJECT) {
            key = read_string(r);
            skip_blanks(r);
            if (!key || !take(r, ':')) return false;
        }
        imp_json *member = read_value(r, depth + 1);
        if (!member) return false;
        member->key = key;
        *link = member;
        link = &member->next;
        node->count++;
        skip_blanks(r);
    } while (take(r, ','));
    return take(r, close);
}

static imp_json *read_value(scanner *r, int depth)
{
    if (depth > DEEPEST) return NULL;
    skip_blanks(r);
    if (r->at == r->end) return NULL;
    imp_json *node = &r->nodes[r->used++];
    *node = (imp_json){.kind = IMP_JSON_NULL};
    if (take_word(r, "null")) return node;
    node->kind = IMP_JSON_TRUE;
    if (take_word(r, "true")) return node;
    node->kind = IMP_JSON_FALSE;
    if (take_word(r, "false")) return node;
    if (*r->at == '"') {
        node->kind = IMP_JSON_STRING;
        node->string = read_string(r);
        return node->string ? node : NULL;
    }
    const bool array = take(r, '[');
    if (array || take(r, '{')) {
        node->kind = array ? IMP_JSON_ARRAY : IMP_JSON_OBJECT;
        return read_members(r, node, array ? ']' : '}', depth) ? node : NULL;
    }
    node->kind = IMP_JSON_NUMBER;
    return read_number(r, &node->number) ? node : NULL;
}

impact_status imp_json_read(imp_arena *arena, const char *text, size_t size, const imp_json **root)
{
    *root = NULL;
    imp_json *nodes = imp_arena_take(arena, size + 1, sizeof *nodes); /* each takes a byte of the text at least */
    char *strings = imp_arena_take(arena, size + 1, 1);
    if (!nodes || !strings) return IMPACT_ENOMEM;
    scanner r = {text, text + size, nodes, 0, strings};
    const imp_json *value = read_value(&r, 0);
    skip_blanks(&r);
    if (!value || r.at != r.end) return IMPACT_EARGUMENT;
    *root = value;
    return IMPACT_OK;
}

const imp_json *imp_json_get(const imp_json *object, const char *key, imp_json_kind kind)
{
    if (!object || object->kind != IMP_JSON_OBJECT) return NULL;
    for (const imp_json *member = object->first; member; member = member->next)
        if (strcmp(member->key, key) == 0) return member->kind == kind ? member : NULL;
    return NULL;
}

double imp_json_number(const imp_json *object, const char *key, double absent, bool *good)
{
    const imp_json *member = imp_json_get(object, key, IMP_JSON_NUMBER);
    if (member) return member->number;
    for (member = object->first; member; member = member->next)
        if (strcmp(member->key, key) == 0 && member->kind != IMP_JSON_NULL) *good = false;
    return absent;
}
