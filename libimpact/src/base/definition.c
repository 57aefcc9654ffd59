/* SPDX-License-Identifier: MIT */
#include "base/definition.h"
#include "base/tolerances.h"

#include <string.h>

size_t imp_definition_size(const void *given)
{
    size_t size;
    if (!given) return 0;
    memcpy(&size, given, sizeof size);
    return size;
}

const char *imp_definition_refusal(const void *given, size_t own_size)
{
    const size_t size = imp_definition_size(given);
    const unsigned char *bytes = given;
    if (!given) return "there is none: NULL was given";
    if (size < sizeof size || size > IMP_MOST_DEFINITION || size % sizeof(void *) != 0)
        return "is no size of this struct: it is sizeof of it, as the functions set it that give defaults";
    for (size_t i = own_size; i < size; i++)
        if (bytes[i] != 0) return "is of a later version, and a field that this library does not know is set";
    return NULL;
}

void imp_definition_take(const void *given, void *own, size_t own_size)
{
    const size_t size = imp_definition_size(given);
    memcpy(own, given, size < own_size ? size : own_size);
    memcpy(own, &own_size, sizeof own_size);
}

void imp_definition_give(const void *own, size_t own_size, void *given, size_t struct_size)
{
    const size_t common = struct_size < own_size ? struct_size : own_size;
    memcpy(given, own, common);
    memset((unsigned char *)given + common, 0, struct_size - common);
    if (struct_size >= sizeof struct_size) memcpy(given, &struct_size, sizeof struct_size);
}
