/* SPDX-License-Identifier: MIT
 *
 * The elliptic kernel against 128-bit arithmetic by other formulas (libquadmath), and against identities.
 */
#include "kit/contact_random.h"
#include "flight/elliptic.h"
#include "kit/near.h"

#ifdef HAVE_QUADMATH
#include "tumble_oracle.h"
#endif

/* m1 = 1 - m over all its magnitudes, near 0 and near 1. */
static double random_complement(random_stream *random)
{
    const double tiny = random_log(random, 1e-18, 1);
    return random_bits(random) % 3 ? tiny : 1 - tiny;
}

/* m is kept apart where m1 is near 1: that is how a body gives them. */
static impact_elliptic make(double m1)
{
    impact_elliptic e;
    imp_elliptic_make(1 - m1, m1, &e);
    return e;
}

static void identities(void **state)
{
    (void)state;
    random_stream random = {1};
    for (int i = 0; i < 200000; i++) {
        const double m1 = random_complement(&random);
        const impact_elliptic e = make(m1);
        const double u = e.K * (2 * random_unit(&random) - 1);
        double sn, cn, dn, sn_, cn_, dn_;
        imp_elliptic_at(&e, u, &sn, &cn, &dn);
        assert_near(sn * sn + cn * cn, 1, 2e-15);
        assert_near(dn * dn + (1 - m1) * sn * sn, 1, 2e-15);
        assert_true(dn >= 0 && cn >= -1e-16);
        imp_elliptic_at(&e, -u, &sn_, &cn_, &dn_);
        assert_true(sn_ == -sn && cn_ == cn && dn_ == dn);
        /* The quarter period: sn(u + K) = cn/dn, dn(u + K) = k'/dn. */
        imp_elliptic_at(&e, u < 0 ? u + e.K : u - e.K, &sn_, &cn_, &dn_);
        assert_near(sn_ * dn, u < 0 ? cn : -cn, 2e-15);
        assert_near(dn_ * dn, sqrt(m1), 2e-15);
    }
}

static void at_the_ends(void **state)
{
    (void)state;
    double sn, cn, dn;
    impact_elliptic circle, separatrix;
    imp_elliptic_make(0, 1, &circle);
    imp_elliptic_make(1, 0, &separatrix);
    assert_near(circle.K, 1.5707963267948966, 3e-16);
    assert_true(isinf(separatrix.K));
    for (double u = -1.5; u < 1.5; u += 0.01) {
        imp_elliptic_at(&circle, u, &sn, &cn, &dn);
        assert_near(sn, sin(u), 3e-16);
        assert_near(cn, cos(u), 3e-16);
        assert_true(dn == 1);
    }
    for (double u = -900; u < 900; u += 0.3) {
        imp_elliptic_at(&separatrix, u, &sn, &cn, &dn);
        assert_near(sn, tanh(u), 3e-16);
        assert_near(cn, 1 / cosh(u), 3e-16);
        assert_true(dn == cn);
    }
    for (double m1 = 1e-18; m1 < 1; m1 *= 3) {
        const impact_elliptic e = make(m1);
        imp_elliptic_at(&e, 0, &sn, &cn, &dn);
        assert_true(sn == 0);
        assert_near(cn, 1, 3e-16);
        assert_near(dn, 1, 3e-16);
        imp_elliptic_at(&e, e.K, &sn, &cn, &dn);
        assert_near(sn, 1, 4e-16);
        assert_near(cn, 0, 2e-16);
        assert_near(dn, sqrt(m1), 4e-16);
    }
}

static void integral_of_the_first_kind(void **state)
{
    (void)state;
    random_stream random = {2};
    for (int i = 0; i < 100000; i++) {
        const double m1 = random_complement(&random);
        const impact_elliptic e = make(m1);
        assert_near(imp_elliptic_rf(0, m1, 1), e.K, 2e-15 * e.K);
        const double u = e.K * (2 * random_unit(&random) - 1);
        double sn, cn, dn;
        imp_elliptic_at(&e, u, &sn, &cn, &dn);
        assert_near(imp_elliptic_inverse(sn, fmax(0, cn), dn), u, 3e-15 * e.K); /* each digit of dn is one of u there */
    }
    assert_near(imp_elliptic_rf(1, 1, 1), 1, 0);
    assert_near(imp_elliptic_rf(1, 2, 0), 1.3110287771460599, 3e-16); /* Carlson (1995), section 3 */
    assert_near(imp_elliptic_rf(0.5, 1, 0), 1.8540746773013719, 3e-16);
    assert_near(imp_elliptic_rf(2, 3, 4), 0.58408284167715170, 3e-16);
    assert_true(isinf(imp_elliptic_rf(0, 0, 1)));
    for (int i = -307; i < 300; i += 3) { /* any ratio is done with within the bound */
        const double small = pow(10, i);
        assert_true(isfinite(imp_elliptic_rf(0, small, 1)) && isfinite(imp_elliptic_rf(small, small / 3, 1)));
    }
    assert_true(isnan(imp_elliptic_rf(NAN, 1, 1)));
}

#ifdef HAVE_QUADMATH
static void against_landen(void **state)
{
    (void)state;
    random_stream random = {3};
    for (int i = 0; i < 3000; i++) {
        const double m1 = random_complement(&random);
        const impact_elliptic e = make(m1);
        assert_near(e.K, oracle_elliptic_k(m1), 6e-16 * e.K);
        const double u = e.K * (2 * random_unit(&random) - 1);
        double got[3], wanted[3];
        imp_elliptic_at(&e, u, &got[0], &got[1], &got[2]);
        oracle_elliptic(m1, u, &wanted[0], &wanted[1], &wanted[2]);
        for (int k = 0; k < 3; k++) assert_near(got[k], wanted[k], 9e-16);
        assert_near(got[2], wanted[2], 5e-14 * wanted[2]); /* dn to its own size: exp(-u) magnifies u's rounding */
    }
}

static void phase_against_its_series(void **state)
{
    (void)state;
    random_stream random = {4};
    for (int i = 0; i < 400; i++) {
        const double m1 = random_log(&random, 1e-15, 1), f = random_unit(&random);
        const impact_elliptic e = make(m1);
        const double other = imp_elliptic_rf(0, 1 - m1, 1); /* K' */
        impact_elliptic_phase phase;
        imp_elliptic_phase_make(&e, f * other, (1 - f) * other, &phase);
        const double u = e.K * (2 * random_unit(&random) - 1);
        assert_near(imp_elliptic_phase_at(&e, &phase, u), oracle_elliptic_phase(m1, u, f), 2e-15);
        const double small = 1e-3;
        const double rate =
            (8 * imp_elliptic_phase_at(&e, &phase, small) - imp_elliptic_phase_at(&e, &phase, 2 * small)) / (6 * small);
        assert_near(phase.slope, rate, 1e-10);
    }
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(identities),
        cmocka_unit_test(at_the_ends),
        cmocka_unit_test(integral_of_the_first_kind),
#ifdef HAVE_QUADMATH
        cmocka_unit_test(against_landen),
        cmocka_unit_test(phase_against_its_series),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
