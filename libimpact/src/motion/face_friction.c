/* SPDX-License-Identifier: MIT */
#include "motion/face_friction.h"
#include "base/tolerances.h"

#include <math.h>
#include <quat/quat.h>
#include <string.h>

typedef struct place {
    double x, y;
} place;

static place at(const double x[2]) { return (place){x[0], x[1]}; }
static place less(place a, place b) { return (place){a.x - b.x, a.y - b.y}; }
static double dot(place a, place b) { return a.x * b.x + a.y * b.y; }
static double cross(place a, place b) { return a.x * b.y - a.y * b.x; }
/* Of what is of the order of 1, or need not be known where it is far less. */
static double face_length(place a) { return sqrt(dot(a, a)); }
static place along(place from, double t, place step) { return (place){from.x + t * step.x, from.y + t * step.y}; }

/* ---- the face and its parts ---- */

static place on_circle(const double center[2], double radius, double angle)
{
    return (place){center[0] + radius * cos(angle), center[1] + radius * sin(angle)};
}

static void push_side(imp_pressed *pressed, place from, place to)
{
    pressed->border[pressed->count++] = (imp_border){.from = {from.x, from.y}, .to = {to.x, to.y}};
}

static void push_arc(imp_pressed *pressed, double begin, double end)
{
    const place from = on_circle(pressed->center, pressed->radius, begin),
                to = on_circle(pressed->center, pressed->radius, end);
    pressed->border[pressed->count++] =
        (imp_border){.arc = true, .from = {from.x, from.y}, .to = {to.x, to.y}, .begin = begin, .end = end};
}

/* The middle of the whole, of which a part's border is no farther. */
static void begin_part(const imp_flat_face *face, imp_pressed *pressed)
{
    pressed->count = 0;
    pressed->line = face->count == IMP_FLAT_LINE;
    pressed->radius = face->radius;
    memcpy(pressed->center, face->center, sizeof pressed->center);
    memcpy(pressed->middle, face->center, sizeof pressed->middle);
    pressed->reach = face->radius;
    if (face->count == 0) return;
    place middle = {0, 0};
    for (int i = 0; i < face->count; i++) middle = along(middle, 1.0 / face->count, at(face->corner[i]));
    pressed->reach = 0;
    for (int i = 0; i < face->count; i++)
        pressed->reach = fmax(pressed->reach, face_length(less(at(face->corner[i]), middle)));
    pressed->middle[0] = middle.x, pressed->middle[1] = middle.y;
}

void imp_press_all(const imp_flat_face *face, imp_pressed *pressed)
{
    const double turn = 2 * acos(-1);
    begin_part(face, pressed);
    if (face->count == 0) push_arc(pressed, 0, turn);
    for (int i = 0; i < (pressed->line ? 1 : face->count); i++)
        push_side(pressed, at(face->corner[i]), at(face->corner[(i + 1) % face->count]));
}

static double pressure_at(const double p[3], place x) { return p[0] + p[1] * x.x + p[2] * x.y; }

/* What the line of no pressure leaves of a disc: an arc about the direction in which pressure grows, and its chord. */
static void press_disc(const imp_flat_face *face, const double p[3], imp_pressed *pressed)
{
    const double slope = hypot(p[1], p[2]), middle = pressure_at(p, at(face->center));
    if (middle + slope * face->radius <= 0) return;
    if (middle - slope * face->radius >= 0) {
        imp_press_all(face, pressed);
        return;
    }
    const double half = acos(-middle / (slope * face->radius)), about = atan2(p[2], p[1]);
    push_arc(pressed, about - half, about + half);
    push_side(pressed, at(pressed->border[0].to), at(pressed->border[0].from));
}

static void press_line(const imp_flat_face *face, const double p[3], imp_pressed *pressed)
{
    const place a = at(face->corner[0]), b = at(face->corner[1]);
    const double from = pressure_at(p, a), to = pressure_at(p, b);
    if (from <= 0 && to <= 0) return;
    const place zero = from * to < 0 ? along(a, from / (from - to), less(b, a)) : a;
    push_side(pressed, from < 0 ? zero : a, to < 0 ? zero : b);
}

void imp_press_part(const imp_flat_face *face, const double p[3], imp_pressed *pressed)
{
    place corner[IMP_FLAT_SIDES + 2];
    int count = 0;
    begin_part(face, pressed);
    if (face->count == 0 || pressed->line) {
        (pressed->line ? press_line : press_disc)(face, p, pressed);
        return;
    }
    for (int i = 0; i < face->count; i++) {
        const place a = at(face->corner[i]), b = at(face->corner[(i + 1) % face->count]);
        const double from = pressure_at(p, a), to = pressure_at(p, b);
        if (from >= 0) corner[count++] = a;
        if ((from > 0 && to < 0) || (from < 0 && to > 0)) corner[count++] = along(a, from / (from - to), less(b, a));
    }
    if (count < 3) return;
    for (int i = 0; i < count; i++) push_side(pressed, corner[i], corner[(i + 1) % count]);
}

double imp_least_pressure(const imp_flat_face *face, const double p[3])
{
    if (face->count == 0) return pressure_at(p, at(face->center)) - hypot(p[1], p[2]) * face->radius;
    double least = INFINITY;
    for (int i = 0; i < face->count; i++) least = fmin(least, pressure_at(p, at(face->corner[i])));
    return least;
}

double imp_side_spare(const imp_flat_face *face, int i, const double x[2])
{
    const place a = at(face->corner[i]), side = less(at(face->corner[(i + 1) % face->count]), a);
    return cross(side, less(at(x), a)) / qvec3_norm((qvec3){side.x, side.y, 0});
}

double imp_face_spare(const imp_flat_face *face, const double x[2])
{
    const place d = less(at(x), at(face->center));
    if (face->count == 0) return face->radius - hypot(d.x, d.y);
    if (face->count == IMP_FLAT_LINE) return fmin(x[0] - face->corner[0][0], face->corner[1][0] - x[0]);
    double least = INFINITY;
    for (int i = 0; i < face->count; i++) least = fmin(least, imp_side_spare(face, i, x));
    return least;
}

/* ---- Gauss's places ---- */

enum { FEW = 8, MANY = 16 };
static const double few_place[FEW / 2] = {0.18343464249564978, 0.525532409916329, 0.7966664774136267,
                                          0.9602898564975362},
                                    few_weight[FEW / 2] = {0.36268378337836166, 0.3137066458778869, 0.22238103445337443,
                                                           0.10122853629037706};
static const double many_place[MANY / 2] = {0.09501250983763744, 0.2816035507792589, 0.45801677765722737,
                                            0.6178762444026438,  0.755404408355003,  0.8656312023878318,
                                            0.9445750230732326,  0.9894009349916499},
                                      many_weight[MANY / 2] = {0.18945061045506864,  0.18260341504492364,
                                                               0.16915651939500265,  0.1495959888165767,
                                                               0.12462897125553407,  0.0951585116824926,
                                                               0.062253523938647456, 0.027152459411754176};

/* The k-th of so many places in [0, 1], and its weight. */
static double gauss(int count, int k, double *weight)
{
    const double *places = count == FEW ? few_place : many_place, *weights = count == FEW ? few_weight : many_weight;
    const int half = count / 2, i = k < half ? half - 1 - k : k - half;
    *weight = 0.5 * weights[i];
    return 0.5 + (k < half ? -0.5 : 0.5) * places[i];
}

/* ---- over the area ---- */

typedef void area_function(place x, double weight, void *sum);

/* The rays from the middle to a piece of border, b(t) with the tangent b', cover x = m + r (b - m), of r (b - m) x b'
 * dr dt. */
static void cover_rays(place middle, place border, place tangent, double weight, area_function *function, void *sum)
{
    const place ray = less(border, middle);
    const double area = cross(ray, tangent);
    for (int k = 0; k < FEW; k++) {
        double part;
        const double r = gauss(FEW, k, &part);
        function(along(middle, r, ray), weight * part * r * area, sum);
    }
}

static void cover_arc(const imp_pressed *pressed, const imp_border *b, area_function *function, void *sum)
{
    const double widest = 0.8; /* rad: eight places give cos^4 over it to rounding */
    const int panels = (int)ceil((b->end - b->begin) / widest);
    const double width = (b->end - b->begin) / panels;
    for (int i = 0; i < panels * FEW; i++) {
        double weight;
        const double angle = b->begin + width * (i / FEW + gauss(FEW, i % FEW, &weight));
        const place x = on_circle(pressed->center, pressed->radius, angle),
                    tangent = {pressed->center[1] - x.y, x.x - pressed->center[0]};
        cover_rays(at(pressed->middle), x, tangent, width * weight, function, sum);
    }
}

static void cover_side(const imp_pressed *pressed, const imp_border *b, area_function *function, void *sum)
{
    const place side = less(at(b->to), at(b->from));
    for (int k = 0; k < FEW; k++) {
        double part;
        const double t = gauss(FEW, k, &part);
        cover_rays(at(pressed->middle), along(at(b->from), t, side), side, part, function, sum);
    }
}

/* Above the diagonal. */
static void add_moment(place x, double weight, void *sum)
{
    double(*m)[3] = sum;
    const double f[3] = {1, x.x, x.y};
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) m[i][j] += weight * f[i] * f[j];
}

/* Of a triangle of the area A: A, a third of it times its corners' sum s, a twelfth of it times s s + the sum of their
 * squares. */
static void add_triangle_moments(place a, place b, place c, double m[3][3])
{
    const double area = cross(less(b, a), less(c, a)) / 2, third = area / 3, twelfth = area / 12;
    const place s = {a.x + b.x + c.x, a.y + b.y + c.y};
    m[0][0] += area;
    m[0][1] += third * s.x;
    m[0][2] += third * s.y;
    m[1][1] += twelfth * (s.x * s.x + a.x * a.x + b.x * b.x + c.x * c.x);
    m[1][2] += twelfth * (s.x * s.y + a.x * a.y + b.x * b.y + c.x * c.y);
    m[2][2] += twelfth * (s.y * s.y + a.y * a.y + b.y * b.y + c.y * c.y);
}

/* Of a line from low to high: its length, and times its middle, and the third of its cubes. */
static void add_line_moments(double low, double high, double m[3][3])
{
    m[0][0] = high - low;
    m[0][1] = m[1][0] = 0.5 * (high - low) * (high + low);
    m[1][1] = (high - low) * (high * high + high * low + low * low) / 3;
}

void imp_press_moments(const imp_pressed *pressed, double m[3][3])
{
    memset(m, 0, 9 * sizeof m[0][0]);
    if (pressed->line) {
        add_line_moments(pressed->border[0].from[0], pressed->border[0].to[0], m);
        return;
    }
    for (int i = 0; i < pressed->count; i++) {
        const imp_border *b = &pressed->border[i];
        if (b->arc)
            cover_arc(pressed, b, add_moment, m);
        else
            add_triangle_moments(at(pressed->middle), at(b->from), at(b->to), m);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < i; j++) m[i][j] = m[j][i];
}

/* ---- friction ---- */

typedef struct rub_sum {
    const double *twist;
    double (*rub)[3];
} rub_sum;

static void add_rub(place x, double weight, void *sum)
{
    const rub_sum *r = sum;
    const double *v = r->twist;
    const place u = {v[0] - v[2] * x.y, v[1] + v[2] * x.x};
    const double part = -weight / face_length(u), force[2] = {part * u.x, part * u.y}, f[3] = {1, x.x, x.y};
    for (int j = 0; j < 3; j++) {
        r->rub[0][j] += f[j] * force[0];
        r->rub[1][j] += f[j] * force[1];
        r->rub[2][j] += f[j] * (x.x * force[1] - x.y * force[0]);
    }
}

/* Along the border, of pressures 1 and x_j - o_j; first: int r/|r|, then |r|. */
typedef struct border_sums {
    double once[2], twice[2][2]; /* of r_i/|r| and r_i r_j/|r|, times r x dr */
    double size, turn[2];        /* of |r| and |r| r_i */
    double inverse;              /* of 1/|r| */
} border_sums;

/* The integral of 1/|r|, asinh(s2/h) - asinh(s1/h), as one: of the argument (s2 r1 - s1 r2)/h^2, by its conjugate where
 * that cancels. */
static double inverse_sum(double h, double s1, double s2, double r1, double r2)
{
    return asinh(s1 * s2 > 0 ? (s2 - s1) * (s2 + s1) / (s2 * r1 + s1 * r2) : (s2 * r1 - s1 * r2) / (h * h));
}

/* s^k/|r| for k = 0, 1, 2 and s^k |r| for k = 0, 1 from s1 to s2, |r|^2 = h^2 + s^2. */
static void add_side_sums(place from, place to, border_sums *sums)
{
    const place side = less(to, from);
    const double length = face_length(side);
    if (!(length > 0)) return;
    const place t = {side.x / length, side.y / length}, n = {t.y, -t.x};
    const double h = dot(n, from), s1 = dot(t, from), s2 = dot(t, to), r1 = face_length(from), r2 = face_length(to);
    if (!(h * h > IMP_NOT_ZERO)) return;
    const double inverse = inverse_sum(h, s1, s2, r1, r2), first = (s2 - s1) * (s2 + s1) / (r1 + r2),
                 second = 0.5 * (s2 * r2 - s1 * r1 - h * h * inverse), size = second + h * h * inverse,
                 turn = (r2 * r2 * r2 - r1 * r1 * r1) / 3;
    const double axis[2][2] = {{n.x, t.x}, {n.y, t.y}};
    for (int i = 0; i < 2; i++) {
        const double a = axis[i][0], b = axis[i][1];
        sums->once[i] += h * (h * a * inverse + b * first);
        sums->turn[i] += h * (h * a * size + b * turn);
        for (int j = 0; j < 2; j++) {
            const double c = axis[j][0], d = axis[j][1];
            sums->twice[i][j] += h * (h * h * a * c * inverse + h * (a * d + b * c) * first + b * d * second);
        }
    }
    sums->size += h * size;
    sums->inverse += h * inverse;
}

static void add_arc_place(place r, place outward, double weight, border_sums *sums)
{
    const double x[2] = {r.x, r.y}, size = face_length(r), across = weight * dot(r, outward);
    if (!(size > 0)) return;
    for (int i = 0; i < 2; i++) {
        sums->once[i] += across * x[i] / size;
        sums->turn[i] += across * size * x[i];
        for (int j = 0; j < 2; j++) sums->twice[i][j] += across * x[i] * x[j] / size;
    }
    sums->size += across * size;
    sums->inverse += across / size;
}

/* From `from` to `to`, away from the angle that is nearest to o, which is off the circle by so much. */
static void add_arc_sums(const imp_pressed *pressed, place o, double nearest, double off, double from, double to,
                         border_sums *sums)
{
    const double way = to > from ? 1 : -1;
    for (double angle = from; way * (to - angle) > 0;) {
        const double grown = 2 * hypot(angle - nearest, off);
        const double next = angle + way * fmin(fmax(grown, IMP_FACE_PANEL), IMP_FACE_WIDEST);
        const double end = way * (to - next) > 0 ? next : to, width = end - angle;
        for (int k = 0; k < MANY; k++) {
            double weight;
            const double there = angle + gauss(MANY, k, &weight) * width;
            const place outward = {cos(there), sin(there)};
            const place x = along(at(pressed->center), pressed->radius, outward);
            add_arc_place(less(x, o), outward, weight * fabs(width) * pressed->radius, sums);
        }
        angle = end;
    }
}

/* The angle nearest to o comes again after each turn: of the arc, what is within half a turn of each. */
static void add_whole_arc(const imp_pressed *pressed, place o, const imp_border *b, border_sums *sums)
{
    const double half = acos(-1);
    const place d = less(o, at(pressed->center));
    const double off = fabs(log(hypot(d.x, d.y) / pressed->radius));
    double nearest = atan2(d.y, d.x);
    nearest += 2 * half * ceil((b->begin - half - nearest) / (2 * half));
    for (; nearest - half < b->end; nearest += 2 * half) {
        const double low = fmax(b->begin, nearest - half), high = fmin(b->end, nearest + half);
        const double start = fmin(fmax(nearest, low), high);
        add_arc_sums(pressed, o, nearest, off, start, low, sums);
        add_arc_sums(pressed, o, nearest, off, start, high, sums);
    }
}

static place centre_of_turning(const double twist[3]) { return (place){-twist[1] / twist[2], twist[0] / twist[2]}; }

static border_sums sums_about(const imp_pressed *pressed, place o)
{
    border_sums sums = {.size = 0};
    for (int i = 0; i < pressed->count; i++) {
        const imp_border *b = &pressed->border[i];
        if (b->arc)
            add_whole_arc(pressed, o, b, &sums);
        else
            add_side_sums(less(at(b->from), o), less(at(b->to), o), &sums);
    }
    return sums;
}

static void rub_along_border(const imp_pressed *pressed, const double twist[3], double rub[3][3])
{
    const place o = centre_of_turning(twist);
    const double way = twist[2] > 0 ? -1 : 1, offset[3] = {1, o.x, o.y};
    const border_sums sums = sums_about(pressed, o);
    for (int j = 0; j < 3; j++) {
        double g[2], size = offset[j] * sums.size / 3;
        for (int i = 0; i < 2; i++) g[i] = offset[j] * sums.once[i] / 2 + (j > 0 ? sums.twice[i][j - 1] / 3 : 0);
        if (j > 0) size += sums.turn[j - 1] / 4;
        rub[0][j] = -way * g[1], rub[1][j] = way * g[0];
        rub[2][j] = way * size + o.x * rub[1][j] - o.y * rub[0][j];
    }
}

/* ---- a line ---- */

/* s^k/rho from s1 to s2, k = 0 ... 3: but for k = 0 of d = 0, which is not asked for alone, but times d. */
static void line_sums(double d, double s1, double s2, double sum[4])
{
    const double r1 = face_length((place){d, s1}), r2 = face_length((place){d, s2});
    sum[0] = d * d > IMP_NOT_ZERO ? inverse_sum(d, s1, s2, r1, r2) : 0;
    sum[1] = r1 + r2 > 0 ? (s2 - s1) * (s2 + s1) / (r1 + r2) : 0;
    sum[2] = 0.5 * (s2 * r2 - s1 * r1 - d * d * sum[0]);
    sum[3] = (r2 * r2 * r2 - r1 * r1 * r1) / 3 - d * d * sum[1];
}

static void rub_along_line(const imp_border *side, const double twist[3], double rub[3][3])
{
    const double way = twist[2] > 0 ? -1 : 1, o = -twist[1] / twist[2], d = twist[0] / twist[2];
    double sum[4];
    line_sums(d, side->from[0] - o, side->to[0] - o, sum);
    rub[0][0] = way * d * sum[0];
    rub[0][1] = way * d * (o * sum[0] + sum[1]);
    rub[1][0] = way * sum[1];
    rub[1][1] = rub[2][0] = way * (o * sum[1] + sum[2]);
    rub[2][1] = way * (o * o * sum[1] + 2 * o * sum[2] + sum[3]);
}

static void cover_line(const imp_pressed *pressed, area_function *function, void *sum)
{
    const place from = at(pressed->border[0].from), side = less(at(pressed->border[0].to), from);
    for (int k = 0; k < MANY; k++) {
        double part;
        const double t = gauss(MANY, k, &part);
        function(along(from, t, side), part * side.x, sum);
    }
}

/* ---- all of them ---- */

static void cover(const imp_pressed *pressed, area_function *function, void *sum)
{
    if (pressed->line) cover_line(pressed, function, sum);
    for (int i = 0; i < pressed->count && !pressed->line; i++)
        (pressed->border[i].arc ? cover_arc : cover_side)(pressed, &pressed->border[i], function, sum);
}

/* Whether the centre of turning is so near that there are sums along the border; else the speed of the middle. */
static bool turns_near(const imp_pressed *pressed, const double twist[3], double *speed)
{
    const double *m = pressed->middle, w = fabs(twist[2]);
    *speed = qvec3_norm((qvec3){twist[0] - twist[2] * m[1], twist[1] + twist[2] * m[0], 0});
    return *speed <= IMP_FACE_DISTANT * w * pressed->reach;
}

void imp_press_rub(const imp_pressed *pressed, const double twist[3], double rub[3][3])
{
    double speed;
    memset(rub, 0, 9 * sizeof rub[0][0]);
    if (turns_near(pressed, twist, &speed)) {
        if (pressed->line)
            rub_along_line(&pressed->border[0], twist, rub);
        else
            rub_along_border(pressed, twist, rub);
        return;
    }
    const double along[3] = {twist[0] / speed, twist[1] / speed, twist[2] / speed};
    rub_sum sum = {along, rub};
    cover(pressed, add_rub, &sum);
}

typedef struct inverse_sum_of {
    const double *twist;
    double sum;
} inverse_sum_of;

static void add_inverse(place x, double weight, void *sum)
{
    inverse_sum_of *own = sum;
    const double *v = own->twist;
    own->sum += weight / face_length((place){v[0] - v[2] * x.y, v[1] + v[2] * x.x});
}

double imp_press_inverse_speed(const imp_pressed *pressed, const double twist[3])
{
    double speed;
    if (turns_near(pressed, twist, &speed))
        return sums_about(pressed, centre_of_turning(twist)).inverse / fabs(twist[2]);
    inverse_sum_of own = {twist, 0};
    cover(pressed, add_inverse, &own);
    return own.sum;
}
