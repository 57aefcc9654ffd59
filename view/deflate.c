/* SPDX-License-Identifier: MIT
 *
 * RFC 1951: what came before is told as (length, distance), the rest byte by byte, with the fixed codes of section
 * 3.2.6; matches are found by chains of places with the same hash of three bytes.
 */
#include "deflate.h"

#include <stdint.h>
#include <string.h>

enum {
    LEAST_MATCH = 3,
    MOST_MATCH = 258,
    WINDOW = 32768,
    HASHES = 1 << 15,
    CHAIN = 128, /* places looked at for one match */
    END_OF_BLOCK = 256,
    FIRST_LENGTH = 257
};

/* Bits, the first in a byte's lowest place. */
typedef struct bits {
    imp_text *out;
    uint32_t held;
    int count;
} bits;

static void put_bits(bits *b, uint32_t value, int count)
{
    b->held |= value << b->count;
    for (b->count += count; b->count >= 8; b->count -= 8) {
        const unsigned char byte = (unsigned char)b->held;
        imp_text_put(b->out, &byte, 1);
        b->held >>= 8;
    }
}

/* A Huffman code stands with its highest bit first. */
static void put_code(bits *b, uint32_t code, int count)
{
    uint32_t reversed = 0;
    for (int i = 0; i < count; i++) reversed |= (code >> i & 1) << (count - 1 - i);
    put_bits(b, reversed, count);
}

static void put_symbol(bits *b, int symbol)
{
    if (symbol < 144)
        put_code(b, 0x30 + (uint32_t)symbol, 8);
    else if (symbol < 256)
        put_code(b, 0x190 + (uint32_t)(symbol - 144), 9);
    else if (symbol < 280)
        put_code(b, (uint32_t)(symbol - 256), 7);
    else
        put_code(b, 0xc0 + (uint32_t)(symbol - 280), 8);
}

/* Lengths and distances stand in groups that double: of `per` symbols each with one more extra bit. */
static int group_of(uint32_t offset, uint32_t per, int *extra, uint32_t *rest)
{
    *extra = 0;
    while (offset >> *extra >= 2 * per) ++*extra;
    *rest = offset & ((1u << *extra) - 1);
    return (int)(per * (uint32_t)*extra + (offset >> *extra));
}

static void put_match(bits *b, int length, int distance)
{
    int extra;
    uint32_t rest;
    const int symbol = group_of((uint32_t)(length - LEAST_MATCH), 4, &extra, &rest);
    if (length == MOST_MATCH) { /* has a symbol of its own */
        put_symbol(b, 285);
    } else {
        put_symbol(b, FIRST_LENGTH + symbol);
        put_bits(b, rest, extra);
    }
    put_code(b, (uint32_t)group_of((uint32_t)(distance - 1), 2, &extra, &rest), 5);
    put_bits(b, rest, extra);
}

/* Where bytes stood, by hash: the last place of each, and of each place the one before. -1: none. */
typedef struct places {
    long last[HASHES];
    long before[WINDOW];
} places;

static unsigned hash_of(const unsigned char *at)
{
    const uint32_t three = at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16;
    return three * 2654435761u >> 17;
}

static void remember(places *p, const unsigned char *bytes, size_t size, size_t at)
{
    if (at + LEAST_MATCH > size) return;
    const unsigned hash = hash_of(bytes + at);
    p->before[at % WINDOW] = p->last[hash];
    p->last[hash] = (long)at;
}

static int match_length(const unsigned char *a, const unsigned char *b, size_t most)
{
    size_t length = 0;
    while (length < most && a[length] == b[length]) length++;
    return (int)length;
}

/* The longest match of what stands at `at`; its length, 0: none. */
static int find_match(const places *p, const unsigned char *bytes, size_t size, size_t at, int *distance)
{
    const size_t most = size - at < MOST_MATCH ? size - at : MOST_MATCH;
    int longest = LEAST_MATCH - 1;
    if (most < LEAST_MATCH) return 0;
    long place = p->last[hash_of(bytes + at)];
    for (int tries = 0; tries < CHAIN && place >= 0 && (long)at - place < WINDOW; tries++) {
        const int length = match_length(bytes + at, bytes + place, most);
        if (length > longest) longest = length, *distance = (int)((long)at - place);
        place = p->before[place % WINDOW];
    }
    return longest < LEAST_MATCH ? 0 : longest;
}

static uint32_t adler(const unsigned char *bytes, size_t size)
{
    uint32_t a = 1, b = 0;
    for (size_t i = 0; i < size; i++) {
        a = (a + bytes[i]) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

void imp_deflate(imp_text *out, const unsigned char *bytes, size_t size)
{
    places *p = imp_arena_take(out->arena, 1, sizeof *p);
    out->failed = out->failed || !p;
    if (!p) return;
    for (int i = 0; i < HASHES; i++) p->last[i] = -1;
    imp_text_put(out, "\x78\x01", 2);
    bits b = {.out = out};
    put_bits(&b, 3, 3); /* the last block, fixed codes */
    for (size_t at = 0; at < size;) {
        int distance = 0;
        const int length = find_match(p, bytes, size, at, &distance);
        if (length > 0)
            put_match(&b, length, distance);
        else
            put_symbol(&b, bytes[at]);
        for (int i = 0; i < (length > 0 ? length : 1); i++) remember(p, bytes, size, at++);
    }
    put_symbol(&b, END_OF_BLOCK);
    put_bits(&b, 0, 7); /* to the end of a byte */
    const uint32_t check = adler(bytes, size);
    const unsigned char tail[4] = {check >> 24, check >> 16 & 255, check >> 8 & 255, check & 255};
    imp_text_put(out, tail, 4);
    imp_arena_give(out->arena, p);
}
