/* SPDX-License-Identifier: MIT */
#include "base/archive.h"

#include <string.h>

imp_archive imp_archive_write(void *bytes, size_t size)
{
    return (imp_archive){.bytes = bytes, .size = size, .sum = 0xcbf29ce484222325u};
}

imp_archive imp_archive_read(const void *bytes, size_t size)
{
    return (imp_archive){.bytes = (unsigned char *)bytes, .size = size, .reading = true, .sum = 0xcbf29ce484222325u};
}

static void take_byte(imp_archive *archive, unsigned char *byte)
{
    const bool here = archive->bytes && archive->at < archive->size;
    if (archive->reading && !here) archive->failed = true;
    if (archive->reading) *byte = here ? archive->bytes[archive->at] : 0;
    if (!archive->reading && here) archive->bytes[archive->at] = *byte;
    archive->sum = (archive->sum ^ *byte) * 0x100000001b3u;
    archive->at++;
}

void imp_archive_word(imp_archive *archive, uint64_t *word)
{
    uint64_t value = 0;
    for (int k = 0; k < 8; k++) {
        unsigned char byte = (unsigned char)(*word >> (8 * k));
        take_byte(archive, &byte);
        value |= (uint64_t)byte << (8 * k);
    }
    *word = value;
}

void imp_archive_double(imp_archive *archive, double *number)
{
    uint64_t word;
    memcpy(&word, number, sizeof word);
    imp_archive_word(archive, &word);
    memcpy(number, &word, sizeof word);
}

void imp_archive_long(imp_archive *archive, long *number)
{
    uint64_t word = (uint64_t)(int64_t)*number;
    imp_archive_word(archive, &word);
    *number = (long)(int64_t)word;
}

void imp_archive_int(imp_archive *archive, int *number, int low, int high)
{
    long value = *number;
    imp_archive_long(archive, &value);
    if (value < low || value > high) archive->failed = true;
    *number = value < low ? low : value > high ? high : (int)value;
}

void imp_archive_bool(imp_archive *archive, bool *flag)
{
    unsigned char byte = *flag;
    take_byte(archive, &byte);
    if (byte > 1) archive->failed = true;
    *flag = byte == 1;
}

void imp_archive_text(imp_archive *archive, char *text, size_t size)
{
    for (size_t k = 0; k < size; k++) {
        unsigned char byte = (unsigned char)text[k];
        take_byte(archive, &byte);
        text[k] = (char)byte;
    }
    if (archive->reading && size > 0) text[size - 1] = '\0';
}
