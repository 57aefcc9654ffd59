/* SPDX-License-Identifier: MIT */
#include "scene/account.h"

impact_status imp_account_open(imp_account *account, imp_arena *arena, int bodies)
{
    int leaves = 1;
    while (leaves < bodies) leaves *= 2;
    const size_t n = (size_t)bodies + 1;
    *account = (imp_account){.leaves = leaves,
                             .sum = imp_arena_take(arena, 2 * (size_t)leaves, sizeof *account->sum),
                             .live = imp_arena_take(arena, n, sizeof *account->live),
                             .place = imp_arena_take(arena, n, sizeof *account->place)};
    if (!account->sum || !account->live || !account->place) return IMPACT_ENOMEM;
    for (int i = 0; i < bodies; i++) account->place[i] = -1;
    return IMPACT_OK;
}

static void set_leaf(imp_account *account, int body, double energy)
{
    int k = account->leaves + body;
    if (account->sum[k] == energy) return;
    account->sum[k] = energy;
    for (k /= 2; k > 0; k /= 2) account->sum[k] = account->sum[2 * k] + account->sum[2 * k + 1];
}

void imp_account_set(imp_account *account, int body, double energy)
{
    const int place = account->place[body];
    if (place >= 0) {
        const int last = account->live[--account->live_count];
        account->live[place] = last;
        account->place[last] = place;
        account->place[body] = -1;
    }
    set_leaf(account, body, energy);
}

void imp_account_set_live(imp_account *account, int body)
{
    set_leaf(account, body, 0);
    if (account->place[body] >= 0) return;
    account->place[body] = account->live_count;
    account->live[account->live_count++] = body;
}

double imp_account_sum(const imp_account *account) { return account->sum[1]; }
