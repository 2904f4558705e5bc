/* @{title} */

#include "@{name}.h"

#include <float.h>
#include <math.h>
#include <string.h>

@{helpers}

@{names}

void @{name}_start(double *t, double *q, double *v)
{
@{start}
}

void @{name}_values(double *p)
{
@{values}
}

@{tables}@{pieces}void @{name}_law(double t, const double *p, double *u)
{
@{law}
}

/* @{operations} operations */
void @{name}_motion(double t, const double *q, const double *v, const double *u, const double *p,
    double *a, double *lambda)
{
@{motion}
}

@{lanes}
void @{name}_motion_batch(size_t points, const double *t, const double *q, const double *v, const double *u,
    const double *p, double *a, double *lambda)
{
    size_t i = 0;
    for (; i + LANES <= points; i += LANES) {
@{many}
    }
    for (; i < points; i++) {
        double qi[@{n} + 1], vi[@{n} + 1], ui[3*@{m} + 1], pi[@{k} + 1], ai[@{n} + 1], li[@{g} + 1];
        for (int j = 0; j < @{n}; j++) qi[j] = q[(size_t)j*points + i], vi[j] = v[(size_t)j*points + i];
        for (int j = 0; j < 3*@{m}; j++) ui[j] = u[(size_t)j*points + i];
        for (int j = 0; j < @{k}; j++) pi[j] = p[(size_t)j*points + i];
        @{name}_motion(t[i], qi, vi, ui, pi, ai, li);
        for (int j = 0; j < @{n}; j++) a[(size_t)j*points + i] = ai[j];
        for (int j = 0; j < @{g}; j++) lambda[(size_t)j*points + i] = li[j];
    }
}

void @{name}_residual(double t, const double *q, const double *v, const double *u, const double *p,
    double *f, double *rate)
{
@{residual}
}

void @{name}_jacobian(double t, const double *q, const double *v, const double *u, const double *p, double *J)
{
@{jacobian}
}

void @{name}_servo(double t, const double *q, const double *v, const double *u, const double *p, double *found)
{
@{servo}
}

void @{name}_observe(double t, const double *q, const double *v, const double *u, const double *p, double *y)
{
@{outputs}
}

static void corrections(double t, const double *q, const double *v, const double *u, const double *p,
    double *dq, double *dv)
{
@{corrections}
}

/* Lengths of the parts of x that different constraints determine. */
static void lengths_of(const double *x, double *lengths)
{
    static const int part[] = {@{part}};
    for (int i = 0; i < @{parts}; i++) lengths[i] = 0;
    for (int s = 0; s < @{n}; s++) lengths[part[s]] += x[s]*x[s];
    for (int i = 0; i < @{parts}; i++) lengths[i] = sqrt(lengths[i]);
}

/* The largest size of numbers, and the numbers with rounding errors. */
static double round_off(const double *x, double *rounded, int count, int pattern)
{
    double largest = 0;
    for (int i = 0; i < count; i++) {
        largest = fmax(largest, fabs(x[i]));
        rounded[i] = x[i]*(1 + ((5*i + pattern) % 8 - 3.5)*DBL_EPSILON);
    }
    return largest;
}

/* For the corrections dq, the largest change of each part within rounding errors of all inputs. Where that is not a
   small part of the inputs, as in a singular configuration, it is zero. */
static void rounding_of_parts(double t, const double *q, const double *v, const double *u, const double *p,
    const double *dq, double *rounding)
{
    double x[@{n}], other[@{n}], dv[@{n}], w[3*@{m} + 1], values[@{k} + 1], lengths[@{parts}];
    for (int i = 0; i < @{parts}; i++) rounding[i] = 0;
    for (int pattern = 0; pattern < 4; pattern++) {
        double largest = round_off(q, x, @{n}, pattern);
        largest = fmax(largest, round_off(u, w, 3*@{m}, 3*pattern + 1));
        largest = fmax(largest, round_off(p, values, @{k}, 6*pattern + 2));
        corrections(t*(1 + pattern*DBL_EPSILON), x, v, w, values, other, dv);
        for (int s = 0; s < @{n}; s++) other[s] -= dq[s];
        lengths_of(other, lengths);
        for (int i = 0; i < @{parts}; i++)
            if (lengths[i] <= sqrt(DBL_EPSILON)*largest) rounding[i] = fmax(rounding[i], lengths[i]);
    }
}

int @{name}_project(double t, double *q, double *v, const double *u, const double *p)
{
    double x[@{n}], dq[@{n}], dv[@{n}], step[@{parts}], next[@{parts}], size[@{parts}], rounding[@{parts}];
    int converged[@{parts}] = {0}, left = @{parts};
    memcpy(x, q, sizeof x);
    corrections(t, x, v, u, p, dq, dv);
    lengths_of(dq, next);
    for (int i = 0; i < @{parts}; i++) step[i] = INFINITY;
    for (;;) {
        for (int i = 0; i < @{parts}; i++) {
            if (converged[i]) continue;
            if (next[i] < step[i]/2) step[i] = next[i];
            else converged[i] = 1, left--; /* if the step is still large, it fails below */
        }
        if (!left) break;
        for (int s = 0; s < @{n}; s++) x[s] += dq[s];
        corrections(t, x, v, u, p, dq, dv);
        lengths_of(dq, next);
    }
    lengths_of(x, size);
    for (int i = 0; i < @{parts}; i++) {
        if (step[i] <= sqrt(DBL_EPSILON)*size[i]) continue;
        rounding_of_parts(t, x, v, u, p, dq, rounding); /* as at a solution that is zero */
        if (!(next[i] <= 16*rounding[i])) return 1;
    }
    for (int s = 0; s < @{n}; s++)
        if (!isfinite(dv[s])) return 1;
    for (int s = 0; s < @{n}; s++) q[s] = x[s], v[s] += dv[s];
    return 0;
}
