/* SPDX-License-Identifier: MIT
 *
 * encounter_kept: encounters as the campaign draws them, by seed and number, and in other frames.
 */
#ifndef ENCOUNTER_KEPT_H
#define ENCOUNTER_KEPT_H

#include "kit/encounter_answer.h"
#include "kit/near.h"

/* Turned, with lengths, masses and times in other units. */
static inline encounter_frame random_frame(random_stream *random)
{
    return (encounter_frame){random_rotation(random), random_log(random, 0.1, 10), random_log(random, 0.1, 10),
                             random_log(random, 0.1, 10)};
}

/* One of the campaign's answered by springs; and how ./run report together draws any. */
typedef struct kept_encounter {
    uint64_t seed, number;
    double exponent;
    int least, most; /* contacts */
} kept_encounter;

static inline random_encounter draw_kept(uint64_t seed, uint64_t number, int least, int most)
{
    const encounter_ranges ranges = {least, most, 10, 0.05, 1e4, 1e4};
    random_stream random = {seed + 0x9e3779b97f4a7c15u * number};
    return encounter_draw(&random, &ranges);
}

/* Answered in so many random frames and units, no farther off than that; the worst receipt. */
static inline double assert_alike_in_frames(random_stream *random, int frames, const random_encounter *e,
                                            impact_together_law law, double exponent, const answer *a, double off)
{
    double worst = 0;
    for (int k = 0; k < frames; k++) {
        const encounter_frame frame = random_frame(random);
        const random_encounter other = change_frame(e, &frame);
        answer b = solve(&other, law, exponent, NULL);
        assert_int_equal(b.status, IMPACT_OK);
        worst = fmax(worst, b.outcome.residual);
        change_back(&b, e->body_count, &frame);
        assert_at_most(distance(e, a, &b), off);
    }
    return worst;
}

#endif
