/* SPDX-License-Identifier: MIT
 *
 * q' = f - kappa q/S in p, S = s + R p: in tau, d tau = dp/S, t = log(1 + R dp/s)/R, all are divided differences of
 * exp,
 *
 *   int q/S dp = q0 t exp[0, -kappa t] + f s t^2 exp[0, -kappa t, R t],
 *   int int q/S dp dp = q0 s t^2 exp[0, (R - kappa) t, R t] + f s^2 t^3 exp[0, (R - kappa) t, R t, 2 R t].
 *
 * exp of the bidiagonal matrix with the nodes z on its diagonal and ones above holds the divided differences of exp
 * (Opitz 1964). By Taylor at z / 2^j, then squared j times (McCurdy, Ng & Parlett 1984): all entries are positive, so
 * that squaring loses nothing; on the diagonal, where it would, exp itself stands.
 */
#include "base/tolerances.h"
#include "collide/collide_swerve.h"

#ifdef IMP_SECOND
enum { EXPONENTIAL_TERMS = 34, NODES = 4 };
#else
enum { EXPONENTIAL_TERMS = 22, NODES = 4 };
#endif

/* f <- 1 + W f / k, W with the nodes w and ones above. */
static void exponential_horner(const imp_real *w, int n, int k, imp_real f[NODES][NODES])
{
    for (int i = 0; i < n; i++)
        for (int j = i; j < n; j++) f[i][j] = (i == j) + (w[i] * f[i][j] + (i < j ? f[i + 1][j] : 0)) / k;
}

/* Of nodes twice as large: exp[2 z_i ... 2 z_k] = sum exp[z_i ... z_j] exp[z_j ... z_k] / 2^(k - i). */
static void exponential_square(int n, imp_real f[NODES][NODES])
{
    for (int i = 0; i < n; i++)
        for (int k = n - 1; k > i; k--) {
            imp_real sum = 0;
            for (int j = i; j <= k; j++) sum += f[i][j] * f[j][k];
            f[i][k] = (imp_real)ldexp(1, i - k) * sum;
        }
}

/* f[i][k] = exp[z_i ... z_k], i <= k < n; nodes may be equal or far apart. */
static void exponential(const imp_real *z, int n, imp_real f[NODES][NODES])
{
    imp_real w[NODES], most = 0;
    for (int i = 0; i < n; i++) most = imp_larger(most, imp_abs(z[i]));
    /* Beyond double's range nothing is left to say: NaN. */
    int halvings = most > 0.5 && most < IMP_COLLIDE_MOST_EXPONENT ? ilogb((double)most) + 2 : 0;
    for (int i = 0; i < n; i++) {
        w[i] = most < IMP_COLLIDE_MOST_EXPONENT ? z[i] * (imp_real)ldexp(1, -halvings) : (imp_real)NAN;
        for (int k = i; k < n; k++) f[i][k] = i == k;
    }
    for (int k = EXPONENTIAL_TERMS; k >= 1; k--) exponential_horner(w, n, k, f);
    for (; halvings > 0; halvings--) {
        exponential_square(n, f);
        for (int i = 0; i < n; i++) {
            w[i] *= 2;
            f[i][i] = imp_exp(w[i]);
        }
    }
}

imp_swerve imp_swerve_over(imp_real s, imp_real R, imp_real kappa, imp_real dp)
{
    imp_real f[NODES][NODES], g[NODES][NODES];
    const imp_real grow = R * dp / s, t = R == 0 ? dp / s : imp_log1p(grow) / R;
    const imp_real z[3] = {0, -kappa * t, R * t}, w[4] = {0, (R - kappa) * t, R * t, 2 * R * t};
    exponential(z, 3, f);
    exponential(w, 4, g);
    return (imp_swerve){t * f[0][1], s * t * t * f[0][2], s * t * t * g[0][2], s * s * t * t * t * g[0][3]};
}

imp_swerve imp_swerve_from_rest(imp_real R, imp_real kappa, imp_real dp)
{
    const imp_real again = dp / (R + kappa);
    return (imp_swerve){0, again, 0, again * dp / 2};
}

imp_swerve imp_swerve_to_rest(imp_real s, imp_real R, imp_real kappa)
{
    const imp_real dp = -s / R, twice = dp / (kappa - R);
    return (imp_swerve){1 / kappa, dp / kappa, twice, dp * twice / 2};
}
