/* SPDX-License-Identifier: MIT
 *
 * stepped: an island whose exact motion does not get on is moved by the steps of a pile (motion/pile.h): when, until
 * when, and what it does to its account. Internal.
 */
#ifndef IMP_STEPPED_H
#define IMP_STEPPED_H

#include "motion/pile.h"
#include "scene/island.h"

/* Counts an event, or a stretch of motion that took so many rates, for each body of the island, several times where it
 * stood (imp_stride); whether one has had so many that the island, in which bodies that move are held on each other or
 * have faces, is to go on by steps. */
bool imp_island_loses_patience(imp_island *island, long rates, bool stood);

/* The island, which has just been gathered with all its bodies' near pairs, begins its steps. */
impact_status imp_island_begin_steps(imp_island *island);

/* The same of an island that is part of one that went by steps: it may rest, and stay so. */
impact_status imp_island_resume_steps(imp_island *island);

/* Whether all its bodies stand still, and can go on so. */
impact_status imp_island_can_stand(imp_island *island, bool *can);

typedef enum imp_stepped {
    IMP_STEPPED_ON,   /* it goes on */
    IMP_STEPPED_REST, /* all its bodies stand still, and can: to be brought to rest */
    IMP_STEPPED_LIES, /* its one body that moves is to lie on its face, where it stands for now or begins to move */
    IMP_STEPPED_LOOK  /* it goes on, but for what has not touched the rest since the last look (imp_pair.met) */
} imp_stepped;

/* The next step, its polynomial in motion.dense. */
impact_status imp_island_step(imp_island *island);
/* What is to be done at the end of the step. */
impact_status imp_island_after_step(imp_island *island, imp_stepped *found);
void imp_island_forget_met(imp_island *island);

/* What friction and impacts of the steps have taken by the island's time, whose states are given, J: energy leaves no
 * other way. */
double imp_island_stepped_loss(const imp_island *island, const imp_state *states, const imp_works *works);

#endif
