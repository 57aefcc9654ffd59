/* SPDX-License-Identifier: MIT
 *
 * json: a strict reader of JSON (RFC 8259), for the head of a recorded run. Internal.
 */
#ifndef IMP_JSON_H
#define IMP_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include "base/arena.h"

typedef enum imp_json_kind {
    IMP_JSON_NULL,
    IMP_JSON_FALSE,
    IMP_JSON_TRUE,
    IMP_JSON_NUMBER,
    IMP_JSON_STRING,
    IMP_JSON_ARRAY,
    IMP_JSON_OBJECT
} imp_json_kind;

typedef struct imp_json imp_json;

/* Members of arrays and objects hang on first and next. */
struct imp_json {
    imp_json_kind kind;
    const char *key; /* in an object; else NULL */
    double number;
    const char *string;
    const imp_json *first, *next;
    int count;
};

/* Everything read from one text stands in the arena, and goes with it. IMPACT_EARGUMENT: no JSON, or deeper than 32;
 * IMPACT_ENOMEM. */
impact_status imp_json_read(imp_arena *arena, const char *text, size_t size, const imp_json **root);

/* The member; NULL when there is none of this kind, or the value is no object. */
const imp_json *imp_json_get(const imp_json *object, const char *key, imp_json_kind kind);
/* The number, or what is taken for an absent or null one; *good is cleared where something else stands. */
double imp_json_number(const imp_json *object, const char *key, double absent, bool *good);

#endif
