/* SPDX-License-Identifier: MIT
 *
 * The Lua sources built into the runner; the array is made by embed.cmake and ends with a NULL module.
 */
#ifndef IMPACT_RUNNER_LAYERS_H
#define IMPACT_RUNNER_LAYERS_H

#include <stddef.h>

typedef struct impact_runner_layer {
    const char *module;
    const unsigned char *source;
    size_t size;
} impact_runner_layer;

extern const impact_runner_layer impact_runner_layers[];

#endif
