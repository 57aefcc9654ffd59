/* SPDX-License-Identifier: MIT
 *
 * test_record.c once more, with files that stand under "PATH.part" as where the file system has none without a name.
 */
#define IMP_OUT_NAMED
#include "base/out_file.c"
#define NAMED true
#include "impact/base/test_record.c"
