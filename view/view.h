/* SPDX-License-Identifier: MIT
 *
 * view: the page's fixed parts, before the title, between title and data, and after them, and its scripts
 * (embed.cmake). Internal.
 */
#ifndef IMP_VIEW_H
#define IMP_VIEW_H

extern const unsigned char imp_view_part_0[], imp_view_part_1[], imp_view_part_2[], imp_view_script[];
extern const unsigned long imp_view_size_0, imp_view_size_1, imp_view_size_2, imp_view_script_size;

#endif
