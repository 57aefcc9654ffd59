/* SPDX-License-Identifier: MIT
 *
 * Newton's cradle of three balls, struck at both contacts at one instant: the first comes with 1 m/s; how they leave by
 * the laws of docs/together.md. Linked as a user's program is.
 */
#include <impact/impact.h>
#include <stdio.h>

static int print_law(const char *name, impact_together_law law, double exponent)
{
    impact_collider balls[3];
    impact_meeting meetings[2];
    for (int i = 0; i < 3; i++)
        balls[i] = (impact_collider){
            .mass = 1, .moments = {0.4, 0.4, 0.4}, .orientation = {1, 0, 0, 0}, .velocity = {i == 0 ? 1 : 0, 0, 0}};
    for (int i = 0; i < 2; i++)
        meetings[i] = (impact_meeting){.body1 = i,
                                       .body2 = i + 1,
                                       .normal = {-1, 0, 0},
                                       .offset1 = {1, 0, 0},
                                       .offset2 = {-1, 0, 0},
                                       .restitution = 1,
                                       .stiffness = 1};
    qvec3 velocity[3];
    impact_together_outcome outcome = {.velocity = velocity};
    const impact_encounter encounter = {
        .bodies = balls, .body_count = 3, .meetings = meetings, .meeting_count = 2, .law = law, .exponent = exponent};
    const impact_status status = impact_collide_together(&encounter, &outcome);
    if (status != IMPACT_OK) {
        fprintf(stderr, "%s: %s\n", name, impact_status_string(status));
        return 1;
    }
    printf("%-16s %13.10f %13.10f %13.10f\n", name, velocity[0].x + 0.0, velocity[1].x + 0.0, velocity[2].x + 0.0);
    return 0;
}

int main(void)
{
    int failed = 0;
    failed |= print_law("springs, linear", IMPACT_TOGETHER_SPRINGS, 1);
    failed |= print_law("springs, Hertz", IMPACT_TOGETHER_SPRINGS, 1.5);
    failed |= print_law("moreau", IMPACT_TOGETHER_MOREAU, 0);
    failed |= print_law("sequence", IMPACT_TOGETHER_SEQUENCE, 0);
    return failed;
}
