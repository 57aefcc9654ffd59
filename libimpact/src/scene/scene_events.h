/* SPDX-License-Identifier: MIT
 *
 * scene_events: what the recorder is told at an event, and the energies there. Internal.
 */
#ifndef IMP_SCENE_EVENTS_H
#define IMP_SCENE_EVENTS_H

#include "scene/scene_internal.h"

/* Kinetic + potential less what drives gave on the way, J: what impacts alone take from. */
double imp_scene_undriven_energy(const imp_island *island);

/* Keeps the states and modes as they are, for the rows before an event. */
void imp_scene_remember(imp_island *island);

/* Whether someone wants to know of events: their energies and words are not made for nobody. */
bool imp_scene_tells_events(const imp_island *island);

/* An event now; its energies are the present ones. */
impact_event imp_scene_event_of_contact(const imp_island *island, impact_event_kind kind,
                                        const imp_held_contact *contact);
impact_event imp_scene_event_of_body(const imp_island *island, impact_event_kind kind, int body);

/* Counts the event, and hands it on between its bodies' rows before and after. A recorder that refuses is not obeyed
 * before all is done that happens at this instant (scene->refused): the scene then stands where it can go on. */
impact_status imp_scene_record(imp_island *island, const impact_event *event);

/* The phases of an impact by their names, in words (of that size), which it returns. */
const char *imp_scene_phases_in_words(const unsigned char *phases, int count, char *words, size_t size);

#endif
