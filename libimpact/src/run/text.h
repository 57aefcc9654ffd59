/* SPDX-License-Identifier: MIT
 *
 * text: bytes that grow, and JSON written into them. Internal.
 */
#ifndef IMP_TEXT_H
#define IMP_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include "base/arena.h"

typedef struct imp_text {
    imp_arena *arena; /* where the bytes stand */
    char *bytes;
    size_t size;
    int room;
    bool failed; /* out of memory: what came later is not there */
} imp_text;

void imp_text_free(imp_text *text);
/* Room for so many bytes more, to be filled; NULL when there is no memory. */
char *imp_text_room(imp_text *text, size_t size);
void imp_text_put(imp_text *text, const void *bytes, size_t size);
void imp_text_say(imp_text *text, const char *words);
/* 17 significant digits, '.' whatever the locale; null where it is not finite. */
void imp_text_number(imp_text *text, double value);
/* Quoted; what JSON does not allow in a string is escaped, and so is '<', so that the text can stand in a page. */
void imp_text_string(imp_text *text, const char *string);

#endif
