/* The five motions of the benchmark by hand: accelerations of (t, q, dot q), for simulation_dop853.c

   Multipliers by the Schur complement  J A^-1 J^T lambda = -(c + J A^-1 h),  solved by LDL^T where
   there are more than two of them; the chain's by Thomas' algorithm, which is chain.c.            */

#include <math.h>

/* Chen, Guo & Mei (2019), eq. (14), under u = 3/10 + t. */
static void paper(double t, const double *y, double *dy)
{
    const double u = 0.3 + t, spring = -(y[0] + y[1]), rate = y[3] + y[4], damping = -2*rate;
    const double lambda = (2*rate + u*(spring + damping))/(1 + 2*u*u);
    dy[0] = y[3];
    dy[1] = y[4];
    dy[2] = y[5];
    dy[3] = spring - u*lambda;
    dy[4] = damping - u*lambda;
    dy[5] = lambda;
}

/* A bob on a string of length 1 + t/10. */
static void pendulum(double t, const double *y, double *dy)
{
    (void)t;
    const double g = 9.81, paid_out = 0.1;
    const double pull = (g*y[1] + paid_out*paid_out - y[2]*y[2] - y[3]*y[3])/(y[0]*y[0] + y[1]*y[1]);
    dy[0] = y[2];
    dy[1] = y[3];
    dy[2] = y[0]*pull;
    dy[3] = y[1]*pull - g;
}

/* Eight masses, the first link drawn in: u = 1 - t/10. */
#define LINKS 8
#include "chain.c"
static void chain_8(double t, const double *y, double *dy)
{
    enum { n = 2*LINKS };
    double in[2*n + 4], out[n + LINKS];
    in[0] = t;
    for (int i = 0; i < 2*n; i++) in[i + 1] = y[i];
    in[2*n + 1] = 1 - 0.1*t;
    in[2*n + 2] = -0.1;
    in[2*n + 3] = 0;
    chain(in, out);
    for (int i = 0; i < n; i++) dy[i] = y[n + i], dy[n + i] = out[i];
}

/* The car axis of the Test Set for IVP Solvers: M eps^2/2 = 5e-4, r = 0.1, w = 10, L = 1, L0 = 1/2, g = 1. */
static void car_axis(double t, const double *y, double *dy)
{
    const double m = 5e-4, r = 0.1, w = 10, L0 = 0.5, g = 1;
    const double xl = y[0], yl = y[1], xr = y[2], yr = y[3];
    const double b = r*sin(w*t), db = w*r*cos(w*t), ddb = -w*w*b;
    const double a = sqrt(1 - b*b), da = -b*db/a, dda = -(db*db + b*ddb + da*da)/a;
    const double xs = xr - a, ys = yr - b;
    const double pull_l = (L0/sqrt(xl*xl + yl*yl) - 1)/m, pull_r = (L0/sqrt(xs*xs + ys*ys) - 1)/m;
    const double h1 = pull_l*xl, h2 = pull_l*yl - g, h3 = pull_r*xs, h4 = pull_r*ys - g;
    const double dx = xl - xr, dy_ = yl - yr, dvx = y[4] - y[6], dvy = y[5] - y[7];
    const double c1 = 2*(y[4]*da + y[5]*db) + xl*dda + yl*ddb, c2 = dvx*dvx + dvy*dvy;
    const double g11 = a*a + b*b, g12 = a*dx + b*dy_, g22 = 2*(dx*dx + dy_*dy_);
    const double r1 = -(c1 + a*h1 + b*h2), r2 = -(c2 + dx*(h1 - h3) + dy_*(h2 - h4));
    const double determinant = g11*g22 - g12*g12;
    const double l1 = (g22*r1 - g12*r2)/determinant, l2 = (g11*r2 - g12*r1)/determinant;
    for (int i = 0; i < 4; i++) dy[i] = y[4 + i];
    dy[4] = h1 + a*l1 + dx*l2;
    dy[5] = h2 + b*l1 + dy_*l2;
    dy[6] = h3 - dx*l2;
    dy[7] = h4 - dy_*l2;
}

/* Inverse of the symmetric matrix [a b; b c] times (x, y). */
static inline void divide_2(double a, double b, double c, double x, double y, double *p, double *q)
{
    const double determinant = a*c - b*b;
    *p = (c*x - b*y)/determinant;
    *q = (a*y - b*x)/determinant;
}

/* Andrews' squeezing mechanism: Schiehlen (1990), as in Hairer & Wanner II, section VII.7. */
static void andrews(double t, const double *y, double *dy)
{
    (void)t;
    const double m1 = 0.04325, m2 = 0.00365, m3 = 0.02373, m4 = 0.00706, m5 = 0.0705, m6 = 0.00706, m7 = 0.05498,
        i1 = 2.194e-6, i2 = 4.41e-7, i3 = 5.255e-6, i4 = 5.667e-7, i5 = 1.169e-5, i6 = 5.667e-7, i7 = 1.912e-5,
        xb = -0.03635, yb = 0.03273, xc = 0.014, yc = 0.072, c0 = 4530, l0 = 0.07785, mom = 0.033,
        d = 0.028, da = 0.0115, e = 0.02, ea = 0.01421, rr = 0.007, ra = 0.00092, ss = 0.035, sa = 0.01874,
        sb = 0.01043, sc = 0.018, sd = 0.02, ta = 0.02308, tb = 0.00916, u = 0.04, ua = 0.01228, ub = 0.00449,
        zf = 0.02, zt = 0.04, fa = 0.01421;
    const double *q = y, *v = y + 7;
    const double sin_b = sin(q[0]), cos_b = cos(q[0]), sin_th = sin(q[1]), cos_th = cos(q[1]);
    const double sin_ga = sin(q[2]), cos_ga = cos(q[2]), sin_ph = sin(q[3]), cos_ph = cos(q[3]);
    const double sin_de = sin(q[4]), cos_de = cos(q[4]), sin_om = sin(q[5]), cos_om = cos(q[5]);
    const double sin_ep = sin(q[6]), cos_ep = cos(q[6]);
    const double sin_bth = sin(q[0] + q[1]), cos_bth = cos(q[0] + q[1]);
    const double sin_phde = sin(q[3] + q[4]), cos_phde = cos(q[3] + q[4]);
    const double sin_omep = sin(q[5] + q[6]), cos_omep = cos(q[5] + q[6]);

    const double a11 = m1*ra*ra + m2*(rr*rr - 2*da*rr*cos_th + da*da) + i1 + i2;
    const double a12 = m2*(da*da - da*rr*cos_th) + i2, a22 = m2*da*da + i2;
    const double a33 = m3*(sa*sa + sb*sb) + i3;
    const double a44 = m4*(e - ea)*(e - ea) + i4, a45 = m4*((e - ea)*(e - ea) + zt*(e - ea)*sin_ph) + i4;
    const double a55 = m4*(zt*zt + 2*zt*(e - ea)*sin_ph + (e - ea)*(e - ea)) + m5*(ta*ta + tb*tb) + i4 + i5;
    const double a66 = m6*(zf - fa)*(zf - fa) + i6, a67 = m6*((zf - fa)*(zf - fa) - u*(zf - fa)*sin_om) + i6;
    const double a77 = m6*((zf - fa)*(zf - fa) - 2*u*(zf - fa)*sin_om + u*u) + m7*(ua*ua + ub*ub) + i6 + i7;

    const double x_spring = sd*cos_ga + sc*sin_ga + xb - xc, y_spring = sd*sin_ga - sc*cos_ga + yb - yc;
    const double pull = -c0*(1 - l0/sqrt(x_spring*x_spring + y_spring*y_spring));
    const double h[7] = {
        mom - m2*da*rr*v[1]*(v[1] + 2*v[0])*sin_th,
        m2*da*rr*v[0]*v[0]*sin_th,
        pull*(x_spring*(sc*cos_ga - sd*sin_ga) + y_spring*(sd*cos_ga + sc*sin_ga)),
        m4*zt*(e - ea)*v[4]*v[4]*cos_ph,
        -m4*zt*(e - ea)*v[3]*(v[3] + 2*v[4])*cos_ph,
        -m6*u*(zf - fa)*v[6]*v[6]*cos_om,
        m6*u*(zf - fa)*v[5]*(v[5] + 2*v[6])*cos_om};

    const double x1 = d*sin_bth - rr*sin_b, x2 = d*sin_bth, y1 = rr*cos_b - d*cos_bth, y2 = -d*cos_bth;
    const double J[6][7] = {
        {x1, x2, -ss*cos_ga},
        {y1, y2, -ss*sin_ga},
        {x1, x2, 0, -e*cos_phde, -e*cos_phde + zt*sin_de},
        {y1, y2, 0, -e*sin_phde, -e*sin_phde - zt*cos_de},
        {x1, x2, 0, 0, 0, zf*sin_omep, zf*sin_omep - u*cos_ep},
        {y1, y2, 0, 0, 0, -zf*cos_omep, -zf*cos_omep - u*sin_ep}};
    const double bth = (v[0] + v[1])*(v[0] + v[1]), phde = (v[3] + v[4])*(v[3] + v[4]);
    const double omep = (v[5] + v[6])*(v[5] + v[6]);
    const double cx = d*cos_bth*bth - rr*cos_b*v[0]*v[0], cy = d*sin_bth*bth - rr*sin_b*v[0]*v[0];
    const double c[6] = {
        cx + ss*sin_ga*v[2]*v[2],
        cy - ss*cos_ga*v[2]*v[2],
        cx + e*sin_phde*phde + zt*cos_de*v[4]*v[4],
        cy - e*cos_phde*phde + zt*sin_de*v[4]*v[4],
        cx + zf*cos_omep*omep + u*sin_ep*v[6]*v[6],
        cy + zf*sin_omep*omep - u*cos_ep*v[6]*v[6]};

    double P[6][7] = {{0}}, G[6][6], lambda[6], free_a[7];
    divide_2(a11, a12, a22, h[0], h[1], &free_a[0], &free_a[1]);
    free_a[2] = h[2]/a33;
    divide_2(a44, a45, a55, h[3], h[4], &free_a[3], &free_a[4]);
    divide_2(a66, a67, a77, h[5], h[6], &free_a[5], &free_a[6]);
    for (int i = 0; i < 6; i++) {
        if (i < 2) divide_2(a11, a12, a22, J[i][0], J[i][1], &P[i][0], &P[i][1]), P[i][2] = J[i][2]/a33;
        else P[i][0] = P[i - 2][0], P[i][1] = P[i - 2][1];
        if (i == 2 || i == 3) divide_2(a44, a45, a55, J[i][3], J[i][4], &P[i][3], &P[i][4]);
        if (i == 4 || i == 5) divide_2(a66, a67, a77, J[i][5], J[i][6], &P[i][5], &P[i][6]);
    }
    const double b11 = P[0][0]*x1 + P[0][1]*x2, b12 = P[0][0]*y1 + P[0][1]*y2, b22 = P[1][0]*y1 + P[1][1]*y2;
    for (int i = 0; i < 6; i++)
        for (int k = 0; k <= i; k++) G[i][k] = (i + k)%2 ? b12 : i%2 ? b22 : b11;
    for (int arm = 0; arm < 3; arm++) {
        const int i = 2*arm, s = arm == 0 ? 2 : 2*arm + 1, last = arm == 0 ? s : s + 1;
        for (int k = s; k <= last; k++) {
            G[i][i] += P[i][k]*J[i][k];
            G[i + 1][i] += P[i + 1][k]*J[i][k];
            G[i + 1][i + 1] += P[i + 1][k]*J[i + 1][k];
        }
    }
    for (int i = 0; i < 6; i++) {
        const int s = i < 2 ? 2 : i < 4 ? 3 : 5, last = i < 2 ? 2 : s + 1;
        lambda[i] = -(c[i] + J[i][0]*free_a[0] + J[i][1]*free_a[1]);
        for (int k = s; k <= last; k++) lambda[i] -= J[i][k]*free_a[k];
    }
    for (int k = 0; k < 6; k++)
        for (int i = k + 1; i < 6; i++) {
            const double factor = G[i][k]/G[k][k];
            for (int j = k + 1; j <= i; j++) G[i][j] -= factor*G[j][k];
            lambda[i] -= factor*lambda[k];
        }
    for (int k = 5; k >= 0; k--) {
        lambda[k] /= G[k][k];
        for (int i = k + 1; i < 6; i++) lambda[k] -= G[i][k]/G[k][k]*lambda[i];
    }
    for (int s = 0; s < 7; s++) {
        dy[s] = v[s];
        dy[7 + s] = free_a[s];
    }
    for (int i = 0; i < 6; i++) {
        const int s = i < 2 ? 2 : i < 4 ? 3 : 5, last = i < 2 ? 2 : s + 1;
        dy[7] += P[i][0]*lambda[i];
        dy[8] += P[i][1]*lambda[i];
        for (int k = s; k <= last; k++) dy[7 + k] += P[i][k]*lambda[i];
    }
}
