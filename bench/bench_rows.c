/* SPDX-License-Identifier: MIT
 *
 * bench_rows: how fast a run writes its rows of CSV, as the runner does: bench_rows.lua, whose table this prints.
 */
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

int main(void)
{
    char folder[] = "/tmp/bench_rows_XXXXXX", command[600];
    if (!mkdtemp(folder)) return 1;
    snprintf(command, sizeof command, "'" RUNNER "' --trust --quiet '" SCRIPT "' -- %s", folder);
    const int status = system(command); // NOLINT: both names are the build's
    rmdir(folder);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? 0 : 1;
}
