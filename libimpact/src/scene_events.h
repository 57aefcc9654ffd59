/* SPDX-License-Identifier: MIT
 *
 * scene_events: what the recorder is told at an event, and the energies there. Internal.
 */
#ifndef IMPACT_SCENE_EVENTS_H
#define IMPACT_SCENE_EVENTS_H

#include "scene_internal.h"

/* Kinetic + potential less what drives gave on the way, J: what impacts alone take from. */
double impact_scene_undriven_energy(const impact_scene *scene);

/* Keeps the states and modes as they are, for the rows before an event. */
void impact_scene_remember(impact_scene *scene);

/* An event now; its energies are the present ones. */
impact_event impact_scene_event_of_touch(const impact_scene *scene, impact_event_kind kind, const impact_touch *touch);
impact_event impact_scene_event_of_body(const impact_scene *scene, impact_event_kind kind, int body);

/* Counts the event, and hands it on between its bodies' rows before and after. */
impact_status impact_scene_record(impact_scene *scene, const impact_event *event);

#endif
