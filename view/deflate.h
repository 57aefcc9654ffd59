/* SPDX-License-Identifier: MIT
 *
 * deflate: bytes made smaller, as browsers undo it (DecompressionStream "deflate"). Internal.
 */
#ifndef IMP_DEFLATE_H
#define IMP_DEFLATE_H

#include "run/text.h"

/* Appends the bytes as a zlib stream (RFC 1950): one block of deflate with fixed codes (RFC 1951, 3.2.6). out->failed
 * when the memory, of its arena, is out. */
void imp_deflate(imp_text *out, const unsigned char *bytes, size_t size);

#endif
