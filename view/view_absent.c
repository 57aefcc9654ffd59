/* SPDX-License-Identifier: MIT */
#include <impact/view.h>
#include <stdio.h>

impact_status impact_view_write(const impact_run *run, double tolerance, const char *path, impact_quota *quota,
                                char *message, unsigned long message_size)
{
    (void)run;
    (void)tolerance;
    (void)path;
    (void)quota;
    if (message) snprintf(message, message_size, "this build writes neither pages nor glTF (IMPACT_WITH_VIEW is off)");
    return IMPACT_EABSENT;
}

impact_status impact_gltf_write(const impact_run *run, double tolerance, double frame_rate, const char *path,
                                impact_quota *quota, char *message, unsigned long message_size)
{
    (void)frame_rate;
    return impact_view_write(run, tolerance, path, quota, message, message_size);
}
