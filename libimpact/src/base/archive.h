/* SPDX-License-Identifier: MIT
 *
 * archive: numbers to bytes and back, the same bytes on every machine: words of eight, the low byte first. One walk
 * over a thing counts, writes or reads it. Internal.
 */
#ifndef IMP_ARCHIVE_H
#define IMP_ARCHIVE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct imp_archive {
    unsigned char *bytes; /* NULL: they are only counted and summed */
    size_t size, at;
    bool reading;
    bool failed;  /* it read beyond the end, or what is no such number */
    uint64_t sum; /* of all bytes so far: FNV-1a, in which no changed byte goes unseen */
} imp_archive;

imp_archive imp_archive_write(void *bytes, size_t size);
imp_archive imp_archive_read(const void *bytes, size_t size);

void imp_archive_word(imp_archive *archive, uint64_t *word);
void imp_archive_double(imp_archive *archive, double *number);
void imp_archive_long(imp_archive *archive, long *number);
/* low <= *number <= high, else it fails. */
void imp_archive_int(imp_archive *archive, int *number, int low, int high);
void imp_archive_bool(imp_archive *archive, bool *flag);
/* A text of so many bytes, its end among them. */
void imp_archive_text(imp_archive *archive, char *text, size_t size);

#endif
