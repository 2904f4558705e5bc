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
        for (int j = 0; j < @{n}; j++) qi[j] = q[j*points + i], vi[j] = v[j*points + i];
        for (int j = 0; j < 3*@{m}; j++) ui[j] = u[j*points + i];
        for (int j = 0; j < @{k}; j++) pi[j] = p[j*points + i];
        @{name}_motion(t[i], qi, vi, ui, pi, ai, li);
        for (int j = 0; j < @{n}; j++) a[j*points + i] = ai[j];
        for (int j = 0; j < @{g}; j++) lambda[j*points + i] = li[j];
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

/* Residuals, as if rounded to 20 bits: how far they are from the others, is their uncertainty with 20 bits. */
static void roughly(double t, const double *q, const double *v, const double *u, const double *p, double *f)
{
@{rough}
}

static double size_of(const double *x)
{
    double squares = 0;
    for (int s = 0; s < @{n}; s++) squares += x[s]*x[s];
    return sqrt(squares);
}

int @{name}_project(double t, double *q, double *v, const double *u, const double *p)
{
    double x[@{n}], dq[@{n}], dv[@{n}], f[@{g} + 1], rate[@{g} + 1], rough[@{g} + 1], step = INFINITY;
    memcpy(x, q, sizeof x);
    corrections(t, x, v, u, p, dq, dv);
    for (double next = size_of(dq); next < step/2; next = size_of(dq)) { /* until steps are rounding */
        step = next;
        for (int s = 0; s < @{n}; s++) x[s] += dq[s];
        corrections(t, x, v, u, p, dq, dv);
    }
    @{name}_residual(t, x, v, u, p, f, rate);
    roughly(t, x, v, u, p, rough);
    for (int b = 0; b < @{g}; b++) /* rounding to 53 bits is 2^-33 of that to 20; steps end where squares underflow */
        if (!(fabs(f[b]) <= 1e-5*fabs(rough[b] - f[b]) + sqrt(DBL_MIN)/DBL_EPSILON)) return 1;
    if (!isfinite(size_of(dv))) return 1;
    for (int s = 0; s < @{n}; s++) q[s] = x[s], v[s] += dv[s];
    return 0;
}
