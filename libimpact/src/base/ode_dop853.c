/* SPDX-License-Identifier: MIT
 *
 * The explicit Runge-Kutta method of order 8 by Dormand and Prince, with errors of orders 5 and 3 within, and its
 * polynomial of order 7 between the ends by three stages more: sixteen rates a step, with one that checks the
 * polynomial, none of them of the steps before, so that the length of a step is free to fall as fast as the motion
 * asks.
 *
 * Hairer, Norsett, Wanner 1993, II.5 and II.6, and their program DOP853, for the method and its numbers.
 */
#include "base/ode_one_step.h"
#include "base/tolerances.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Stages 0 .. 11; that of the step's end, which is the next one's begin; and three more. */
enum { DOP853_STAGES = 16, DOP853_END = 12, DOP853_TERMS = 8, DOP853_ORDER = 8 };

typedef struct weight {
    int row, column;
    double value;
} weight;

static const double stage_place[DOP853_STAGES] = {0.0,
                                                  0.05260015195876773,
                                                  0.0789002279381516,
                                                  0.1183503419072274,
                                                  0.2816496580927726,
                                                  0.3333333333333333,
                                                  0.25,
                                                  0.3076923076923077,
                                                  0.6512820512820513,
                                                  0.6,
                                                  0.8571428571428571,
                                                  1.0,
                                                  1.0,
                                                  0.1,
                                                  0.2,
                                                  0.7777777777777778};
static const weight stage_weight[] = {
    {1, 0, 0.05260015195876773},       {2, 0, 0.0197250569845379},        {2, 1, 0.0591751709536137},
    {3, 0, 0.02958758547680685},       {3, 2, 0.08876275643042054},       {4, 0, 0.2413651341592667},
    {4, 2, -0.8845494793282861},       {4, 3, 0.924834003261792},         {5, 0, 0.037037037037037035},
    {5, 3, 0.17082860872947386},       {5, 4, 0.12546768756682242},       {6, 0, 0.037109375},
    {6, 3, 0.17025221101954405},       {6, 4, 0.06021653898045596},       {6, 5, -0.017578125},
    {7, 0, 0.03709200011850479},       {7, 3, 0.17038392571223998},       {7, 4, 0.10726203044637328},
    {7, 5, -0.015319437748624402},     {7, 6, 0.008273789163814023},      {8, 0, 0.6241109587160757},
    {8, 3, -3.3608926294469414},       {8, 4, -0.868219346841726},        {8, 5, 27.59209969944671},
    {8, 6, 20.154067550477894},        {8, 7, -43.48988418106996},        {9, 0, 0.47766253643826434},
    {9, 3, -2.4881146199716677},       {9, 4, -0.590290826836843},        {9, 5, 21.230051448181193},
    {9, 6, 15.279233632882423},        {9, 7, -33.28821096898486},        {9, 8, -0.020331201708508627},
    {10, 0, -0.9371424300859873},      {10, 3, 5.186372428844064},        {10, 4, 1.0914373489967295},
    {10, 5, -8.149787010746927},       {10, 6, -18.52006565999696},       {10, 7, 22.739487099350505},
    {10, 8, 2.4936055526796523},       {10, 9, -3.0467644718982196},      {11, 0, 2.273310147516538},
    {11, 3, -10.53449546673725},       {11, 4, -2.0008720582248625},      {11, 5, -17.9589318631188},
    {11, 6, 27.94888452941996},        {11, 7, -2.8589982771350235},      {11, 8, -8.87285693353063},
    {11, 9, 12.360567175794303},       {11, 10, 0.6433927460157636},      {12, 0, 0.054293734116568765},
    {12, 5, 4.450312892752409},        {12, 6, 1.8915178993145003},       {12, 7, -5.801203960010585},
    {12, 8, 0.3111643669578199},       {12, 9, -0.1521609496625161},      {12, 10, 0.20136540080403034},
    {12, 11, 0.04471061572777259},     {13, 0, 0.056167502283047954},     {13, 6, 0.25350021021662483},
    {13, 7, -0.2462390374708025},      {13, 8, -0.12419142326381637},     {13, 9, 0.15329179827876568},
    {13, 10, 0.00820105229563469},     {13, 11, 0.007567897660545699},    {13, 12, -0.008298},
    {14, 0, 0.03183464816350214},      {14, 5, 0.028300909672366776},     {14, 6, 0.053541988307438566},
    {14, 7, -0.05492374857139099},     {14, 10, -0.00010834732869724932}, {14, 11, 0.0003825710908356584},
    {14, 12, -0.00034046500868740456}, {14, 13, 0.1413124436746325},      {15, 0, -0.42889630158379194},
    {15, 5, -4.697621415361164},       {15, 6, 7.683421196062599},        {15, 7, 4.06898981839711},
    {15, 8, 0.3567271874552811},       {15, 12, -0.0013990241651590145},  {15, 13, 2.9475147891527724},
    {15, 14, -9.15095847217987}};
static const weight error_5[] = {{0, 0, 0.01312004499419488},  {0, 5, -1.2251564463762044},
                                 {0, 6, -0.4957589496572502},  {0, 7, 1.6643771824549864},
                                 {0, 8, -0.35032884874997366}, {0, 9, 0.3341791187130175},
                                 {0, 10, 0.08192320648511571}, {0, 11, -0.022355307863886294}};
static const weight error_3[] = {{0, 0, -0.18980075407240762}, {0, 5, 4.450312892752409},   {0, 6, 1.8915178993145003},
                                 {0, 7, -5.801203960010585},   {0, 8, -0.4226823213237919}, {0, 9, -0.1521609496625161},
                                 {0, 10, 0.20136540080403034}, {0, 11, 0.02265179219836082}};
static const weight between_weight[] = {
    {0, 0, -8.428938276109013},   {0, 5, 0.5667149535193777},  {0, 6, -3.0689499459498917},
    {0, 7, 2.38466765651207},     {0, 8, 2.117034582445028},   {0, 9, -0.871391583777973},
    {0, 10, 2.2404374302607883},  {0, 11, 0.6315787787694688}, {0, 12, -0.08899033645133331},
    {0, 13, 18.148505520854727},  {0, 14, -9.194632392478356}, {0, 15, -4.436036387594894},
    {1, 0, 10.427508642579134},   {1, 5, 242.28349177525817},  {1, 6, 165.20045171727028},
    {1, 7, -374.5467547226902},   {1, 8, -22.113666853125306}, {1, 9, 7.733432668472264},
    {1, 10, -30.674084731089398}, {1, 11, -9.332130526430229}, {1, 12, 15.697238121770845},
    {1, 13, -31.139403219565178}, {1, 14, -9.35292435884448},  {1, 15, 35.81684148639408},
    {2, 0, 19.985053242002433},   {2, 5, -387.0373087493518},  {2, 6, -189.17813819516758},
    {2, 7, 527.8081592054236},    {2, 8, -11.57390253995963},  {2, 9, 6.8812326946963},
    {2, 10, -1.0006050966910838}, {2, 11, 0.7777137798053443}, {2, 12, -2.778205752353508},
    {2, 13, -60.19669523126412},  {2, 14, 84.32040550667716},  {2, 15, 11.99229113618279},
    {3, 0, -25.69393346270375},   {3, 5, -154.18974869023643}, {3, 6, -231.5293791760455},
    {3, 7, 357.6391179106141},    {3, 8, 93.40532418362432},   {3, 9, -37.45832313645163},
    {3, 10, 104.0996495089623},   {3, 11, 29.8402934266605},   {3, 12, -43.53345659001114},
    {3, 13, 96.32455395918828},   {3, 14, -39.17726167561544}, {3, 15, -149.72683625798564}};

typedef struct dop853_ode {
    imp_one_step one;
    double *rate[DOP853_STAGES];
} dop853_ode;

static dop853_ode *dop853_of(const imp_one_step *one) { return (dop853_ode *)(uintptr_t)one; }

/* DOP853's nested form about the step's begin, x = 1 + s,
 *     y = y_0 + x (F_0 + (1 - x) (F_1 + x (F_2 + (1 - x) (F_3 + x (F_4 + (1 - x) (F_5 + x F_6)))))),
 * multiplied out in powers of s. */
static void make_dop853_polynomial(imp_one_step *one, double h)
{
    enum { DOP853_PARTS = 7 };
    const dop853_ode *own = dop853_of(one);
    memcpy(one->term[0], one->y, sizeof *one->y * (size_t)one->ode.size);
    for (int i = 0; i < one->ode.size; i++) {
        const double rise = one->y[i] - one->before[i], first = h * one->first[i], last = h * one->last[i];
        double part[DOP853_PARTS] = {rise, first - rise, 2 * rise - (first + last)}, c[DOP853_TERMS] = {0};
        for (size_t k = 0; k < sizeof between_weight / sizeof *between_weight; k++)
            part[3 + between_weight[k].row] += h * between_weight[k].value * own->rate[between_weight[k].column][i];
        for (int k = DOP853_PARTS - 1; k >= 0; k--) { /* c := (c + part) times x, or 1 - x = -s */
            c[0] += part[k];
            for (int m = DOP853_TERMS - 1; m > 0; m--) c[m] = k % 2 == 0 ? c[m] + c[m - 1] : -c[m - 1];
            if (k % 2 == 1) c[0] = 0;
        }
        for (int m = 1; m < DOP853_TERMS; m++) one->term[m][i] = c[m];
    }
}

/* y of the stage that begins with that weight, and its rate; *weights is then where the next one's begin. */
static imp_one_step_outcome take_stage(dop853_ode *own, const weight **weights, double t, double end, double t_stop)
{
    imp_one_step *one = &own->one;
    const int stage = (*weights)->row, n = one->ode.size;
    const weight *last = stage_weight + sizeof stage_weight / sizeof *stage_weight;
    double *y = stage == DOP853_END ? one->y : one->roots.state;
    for (int i = 0; i < n; i++) y[i] = 0;
    for (; *weights < last && (*weights)->row == stage; ++*weights)
        for (int i = 0; i < n; i++) y[i] += (*weights)->value * own->rate[(*weights)->column][i];
    for (int i = 0; i < n; i++) y[i] = one->before[i] + (end - t) * y[i];
    const double time = stage_place[stage] == 1 ? end : t + stage_place[stage] * (end - t);
    return imp_one_step_rate(one, time, t_stop, y, own->rate[stage]);
}

/* The stages up to that one. */
static imp_one_step_outcome take_stages(dop853_ode *own, const weight **weights, int up_to, double t, double end,
                                        double t_stop)
{
    imp_one_step_outcome outcome = IMP_STEP_STANDS;
    const weight *last = stage_weight + sizeof stage_weight / sizeof *stage_weight;
    while (outcome == IMP_STEP_STANDS && *weights < last && (*weights)->row <= up_to)
        outcome = take_stage(own, weights, t, end, t_stop);
    return outcome;
}

/* The greatest component of what those weights make of the rates, in scales; all have a sum of 0. */
static double error_by(const dop853_ode *own, const weight *weights, size_t count, double h)
{
    const imp_one_step *one = &own->one;
    double most = 0;
    for (int i = 0; i < one->ode.size; i++) {
        double sum = 0;
        for (size_t k = 0; k < count; k++) sum += weights[k].value * (own->rate[weights[k].column][i] - one->first[i]);
        const double error = fmax(fabs(h * sum) - IMP_ONE_STEP_ROUNDING * fabs(h * one->first[i]), 0) / one->scale[i];
        if (!(error <= most)) most = error;
    }
    return most;
}

/* The error, in scales: the fifth order's, the less the further it is below the third's. */
static double dop853_error(const dop853_ode *own, double h)
{
    const double five = error_by(own, error_5, sizeof error_5 / sizeof *error_5, h),
                 three = error_by(own, error_3, sizeof error_3 / sizeof *error_3, h);
    if (!isfinite(five + three)) return INFINITY;
    return five > 0 ? five * five / sqrt(five * five + 0.01 * three * three) : 0;
}

/* The polynomial's defect in the middle of the step, |p' - f(t, p)| h, in scales: what is cut off at an event, or met
 * within the step, is to be as right as the ends are (Enright 1989). */
static imp_one_step_outcome dop853_defect(dop853_ode *own, double t, double h, double *defect)
{
    imp_one_step *one = &own->one;
    double *there = one->roots.state, *rate = own->rate[1];
    imp_one_step_at(one, 0, -0.5, h, there);
    const imp_one_step_outcome outcome = imp_one_step_rate(one, t + 0.5 * h, INFINITY, there, rate);
    imp_one_step_at(one, 1, -0.5, h, one->slope);
    *defect = 0;
    for (int i = 0; i < one->ode.size; i++) {
        const double off = fmax(fabs(h * (one->slope[i] - rate[i])) - IMP_ONE_STEP_ROUNDING * fabs(h * rate[i]), 0);
        if (!(off / one->scale[i] <= *defect)) *defect = off / one->scale[i];
    }
    return outcome;
}

/* The step's error, in scales: that of its end, and where that stands that of its polynomial. */
static imp_one_step_outcome try_dop853_step(dop853_ode *own, double t, double end, double t_stop, double *error)
{
    const weight *weights = stage_weight;
    double defect = 0;
    imp_one_step_outcome outcome = take_stages(own, &weights, DOP853_END, t, end, t_stop);
    *error = INFINITY;
    if (outcome != IMP_STEP_STANDS) return outcome;
    *error = dop853_error(own, end - t);
    if (*error > 1) return outcome;
    outcome = take_stages(own, &weights, DOP853_STAGES, t, end, t_stop);
    if (outcome != IMP_STEP_STANDS) return outcome;
    make_dop853_polynomial(&own->one, end - t);
    outcome = dop853_defect(own, t, end - t, &defect);
    if (!(IMP_DOP853_DEFECT * defect <= *error)) *error = IMP_DOP853_DEFECT * defect;
    return outcome;
}

/* As the error, which goes as h^8, allows; half where there is none. */
static double next_dop853_length(double h, double error)
{
    const double least = 0.2, none = 0.5;
    if (!isfinite(error)) return none * fabs(h);
    return fabs(h) * fmax(0.9 * pow(fmax(error, IMP_ONE_STEP_GROWTH), -1.0 / DOP853_ORDER), least);
}

/* Shorter and shorter until it stands. */
static impact_status take_dop853_step(imp_one_step *one, double t, double t_stop, double *end)
{
    for (double failed = INFINITY;;) {
        *end = imp_one_step_end(one, t, t_stop);
        const double h = *end - t;
        double error;
        if (!(h != 0 && fabs(h) < failed)) return imp_one_step_too_short(one);
        imp_one_step_set_scale(one, h);
        const imp_one_step_outcome outcome = try_dop853_step(dop853_of(one), t, *end, t_stop, &error);
        if (outcome == IMP_STEP_GAVE_UP) return imp_one_step_gave_up(one, h);
        if (outcome == IMP_STEP_TOO_LONG) error = INFINITY;
        one->h = next_dop853_length(h, error);
        if (error <= 1) return IMPACT_OK;
        failed = fabs(h);
        one->counts.error_test_failures++;
    }
}

static impact_status dop853_open(impact_ode *ode)
{
    static const imp_one_step_method method = {
        .terms = DOP853_TERMS, .order = DOP853_ORDER, .vectors = DOP853_STAGES, .take = take_dop853_step};
    static const double halves[] = {0.5, 1};
    imp_one_step *one = (imp_one_step *)ode;
    dop853_ode *own = dop853_of(one);
    double *next;
    const impact_status status = imp_one_step_open(ode, &method, &next);
    if (status != IMPACT_OK) return status;
    for (int k = 0; k < DOP853_STAGES; k++, next += ode->def.size) own->rate[k] = next;
    one->first = own->rate[0], one->last = own->rate[DOP853_END];
    one->look = halves, one->looks = 2;
    return IMPACT_OK;
}

const imp_ode_driver imp_ode_dop853 = {.bytes = sizeof(dop853_ode),
                                       .open = dop853_open,
                                       .close = imp_one_step_close,
                                       .resize = imp_one_step_resize,
                                       .start = imp_one_step_start,
                                       .limit_step = imp_one_step_limit,
                                       .set_tolerances = imp_one_step_set_tolerances,
                                       .step = imp_one_step_go,
                                       .interpolate = imp_one_step_interpolate,
                                       .count = imp_one_step_count};
