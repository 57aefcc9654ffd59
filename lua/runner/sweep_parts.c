/* SPDX-License-Identifier: MIT
 *
 * Rows on the disk: NAME.SHARD-K.rows. "impact sweep 1 HASH RUNS p1,p2,...\n", then blocks "@ SIZE CHECKSUM\n" and SIZE
 * bytes of lines. One process writes a part, and only at its end; another takes the next free K.
 */
#define _GNU_SOURCE
#include "sweep.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_PARTS = 1000000, HEAD = 40 };

/* FNV-1a, 64 bits (Fowler, Noll, Vo); begun with hash 0. */
uint64_t impact_sweep_hash(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *byte = bytes;
    if (hash == 0) hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < size; i++) hash = (hash ^ byte[i]) * UINT64_C(0x100000001b3);
    return hash;
}

bool impact_sweep_add(impact_sweep_block *block, const char *text, size_t size)
{
    if (block->size + size > block->room) {
        const size_t room = 2 * (block->size + size) + 4096;
        char *more = realloc(block->text, room);
        if (!more) return false;
        block->text = more, block->room = room;
    }
    memcpy(block->text + block->size, text, size);
    block->size += size;
    return true;
}

/* ---- writing ---- */

static int head_line(const impact_sweep_id *id, char *line, size_t size)
{
    return snprintf(line, size, "impact sweep 1 %016" PRIx64 " %ld %s\n", id->hash, id->runs, id->parameters);
}

int impact_sweep_new_part(impact_runner *runner, const impact_sweep_id *id, char *message, size_t size)
{
    char name[240], line[2100];
    int part = -1;
    if (!impact_runner_open_folder(runner, message, size)) return -1;
    errno = EEXIST;
    for (int k = 1; part < 0 && errno == EEXIST && k < MOST_PARTS; k++) {
        snprintf(name, sizeof name, "%s.%d-%d.rows", id->name, runner->shard, k);
        part = openat(runner->folder, name, O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
    }
    const int length = head_line(id, line, sizeof line);
    if (part >= 0 && impact_runner_spend(runner, (unsigned long long)length) &&
        impact_runner_write(part, line, (size_t)length))
        return part;
    snprintf(message, size, "cannot write '%s/%s': %s", runner->directory, name, strerror(errno));
    if (part >= 0) close(part);
    return -1;
}

bool impact_sweep_write_block(impact_runner *runner, int part, impact_sweep_block *block)
{
    char head[HEAD];
    if (block->size == 0) return true;
    const int length = snprintf(head, sizeof head, "@ %zu %016" PRIx64 "\n", block->size,
                                impact_sweep_hash(0, block->text, block->size));
    const bool good = impact_runner_spend(runner, (unsigned long long)length + block->size) &&
                      impact_runner_write(part, head, (size_t)length) &&
                      impact_runner_write(part, block->text, block->size);
    block->size = 0;
    return good;
}

/* ---- reading ---- */

/* All bytes of an open file; false with errno. */
static bool read_bytes(int file, char **text, size_t *size)
{
    struct stat status;
    size_t got = 0;
    if (fstat(file, &status) != 0) return false;
    *text = malloc((size_t)status.st_size + 1);
    while (*text && got < (size_t)status.st_size) {
        const ssize_t more = read(file, *text + got, (size_t)status.st_size - got);
        if (more < 0 && errno == EINTR) continue;
        if (more < 0) return free(*text), *text = NULL, false;
        if (more == 0) break; /* another took from it meanwhile */
        got += (size_t)more;
    }
    if (*text) (*text)[got] = 0;
    *size = got;
    return *text != NULL;
}

/* False with errno: it cannot be read; ELOOP: it is a link. */
static bool read_file(int folder, const char *name, char **text, size_t *size)
{
    int file;
    *text = NULL;
    do file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    while (file < 0 && errno == EINTR);
    if (file < 0) return false;
    const bool good = read_bytes(file, text, size);
    const int why = errno;
    close(file);
    return errno = why, good;
}

/* The first line; how long it is, 0 where it is none of ours (a process that died before it had written one). */
static size_t read_head(const char *text, size_t size, impact_sweep_id *id)
{
    int at = 0;
    const char *end = memchr(text, '\n', size);
    if (!end || sscanf(text, "impact sweep 1 %16" SCNx64 " %ld%n", &id->hash, &id->runs, &at) != 2 || text[at++] != ' ')
        return 0;
    const size_t length = (size_t)(end - text);
    if ((size_t)at > length || length - (size_t)at >= sizeof id->parameters || id->runs < 1) return 0;
    memcpy(id->parameters, text + at, length - (size_t)at);
    id->parameters[length - (size_t)at] = 0;
    return length + 1;
}

/* Moves the good blocks' lines together, to the front of the text; how many bytes they are. */
static size_t join_blocks(char *text, size_t size, size_t at)
{
    size_t joined = 0;
    while (at < size) {
        size_t length;
        uint64_t checksum;
        int head = 0;
        if (sscanf(text + at, "@ %zu %16" SCNx64 "%n", &length, &checksum, &head) != 2 ||
            text[at + (size_t)head] != '\n')
            break;
        at += (size_t)head + 1;
        if (length > size - at || impact_sweep_hash(0, text + at, length) != checksum) break;
        memmove(text + joined, text + at, length);
        joined += length, at += length;
    }
    return joined;
}

/* NAME of NAME.SHARD-K.rows; false: another file. */
static bool part_name(const char *file, char name[200])
{
    const size_t length = strlen(file);
    size_t stem = length > 5 && strcmp(file + length - 5, ".rows") == 0 ? length - 5 : 0;
    for (const char *before = "-."; *before; before++) { /* SHARD-K, from its end */
        const size_t digits = stem;
        while (stem > 0 && file[stem - 1] >= '0' && file[stem - 1] <= '9') stem--;
        if (stem == digits || stem < 2 || file[stem - 1] != *before) return false;
        stem -= *before == '-';
    }
    if (stem - 1 >= 200) return false;
    memcpy(name, file, stem - 1);
    name[stem - 1] = 0;
    return true;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(((const impact_sweep_part *)a)->id.name, ((const impact_sweep_part *)b)->id.name);
}

/* One more of the parts; false: out of memory. */
static bool grow_parts(impact_sweep_part **parts, int count, int *room)
{
    if (count < *room) return true;
    impact_sweep_part *more = realloc(*parts, (size_t)(2 * *room + 8) * sizeof **parts);
    if (!more) return false;
    *parts = more, *room = 2 * *room + 8;
    return true;
}

/* All parts in the folder, of one name or (NULL) of all; -1 with errno, and *file the name of what cannot be read. */
static int list_parts(int folder, DIR *listing, const char *name, impact_sweep_part **parts, char file[256])
{
    int count = 0, room = 0;
    char stem[200];
    for (const struct dirent *entry; (entry = readdir(listing));) {
        if (!part_name(entry->d_name, stem) || (name && strcmp(stem, name) != 0)) continue;
        snprintf(file, 256, "/%s", entry->d_name);
        if (!grow_parts(parts, count, &room)) return impact_sweep_free_parts(*parts, count), -1;
        impact_sweep_part *part = &(*parts)[count];
        if (!read_file(folder, entry->d_name, &part->text, &part->size)) {
            if (errno == ELOOP) continue; /* nothing here follows a link */
            const int why = errno;
            impact_sweep_free_parts(*parts, count);
            return errno = why, -1;
        }
        const size_t head = read_head(part->text, part->size, &part->id);
        snprintf(part->id.name, sizeof part->id.name, "%s", stem);
        part->size = head ? join_blocks(part->text, part->size, head) : 0;
        if (head)
            count++;
        else
            free(part->text);
    }
    return count;
}

int impact_sweep_read_parts(impact_runner *runner, const char *name, impact_sweep_part **parts, char *message,
                            size_t size)
{
    char file[256] = "";
    const int folder = dup(runner->folder);
    DIR *listing = folder >= 0 ? fdopendir(folder) : NULL;
    *parts = NULL;
    int count = -1;
    if (listing) rewinddir(listing), count = list_parts(runner->folder, listing, name, parts, file);
    if (count < 0) {
        snprintf(message, size, "cannot read '%s%s': %s", runner->directory, file, strerror(errno));
        *parts = NULL;
    }
    if (listing) closedir(listing);
    if (count > 1) qsort(*parts, (size_t)count, sizeof **parts, by_name);
    return count;
}

void impact_sweep_free_parts(impact_sweep_part *parts, int count)
{
    for (int i = 0; i < count; i++) free(parts[i].text);
    free(parts);
}

const char *impact_sweep_next_line(const impact_sweep_part *part, size_t *at, size_t *length)
{
    if (*at >= part->size) return NULL;
    const char *line = part->text + *at, *end = memchr(line, '\n', part->size - *at);
    if (!end) return NULL;
    *length = (size_t)(end - line);
    *at += *length + 1;
    return line;
}
