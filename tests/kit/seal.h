/* SPDX-License-Identifier: MIT
 *
 * The sum that a recorded run ends with (docs/run.md), put right after bytes before it were changed: what is beyond the
 * sum is what is tried then. CRC-32 bit by bit through a table of four bits' remainders, not the library's own.
 */
#ifndef KIT_SEAL_H
#define KIT_SEAL_H

#include <stddef.h>
#include <stdint.h>

enum { SEAL = 8 };

static void seal(char *bytes, size_t size)
{
    static const uint32_t four[16] = {0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4,
                                      0x4db26158, 0x5005713c, 0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
                                      0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};
    uint32_t crc = 0xffffffff;
    if (size < SEAL) return;
    for (size_t i = 0; i < size - SEAL; i++) {
        crc ^= (unsigned char)bytes[i];
        crc = crc >> 4 ^ four[crc & 15];
        crc = crc >> 4 ^ four[crc & 15];
    }
    for (size_t i = 0; i < SEAL; i++) bytes[size - SEAL + i] = i < 4 ? (char)(~crc >> 8 * i & 255) : 0;
}

#endif
