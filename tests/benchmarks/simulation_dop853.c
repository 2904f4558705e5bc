/* Dormand & Prince 8(5,3) with its right-hand side compiled in

   Hairer, Norsett & Wanner I, section II.10: step-size control as in their code DOP853, without
   dense output. simulation_peers.py puts the motion's function before this text, N and MOTION, and
   the twelve stages with the sums of solution and error estimates, coefficients written out:
   STAGES takes  t, h, y, k1  to  k2 ... k12  by way of  w;  each SUM(k) is one of a component.  */

#include <string.h>

static double size_of(const double *x, const double *y, double tolerance)
{
    double sum = 0;
    for (int i = 0; i < N; i++) {
        const double scaled = x[i]/(tolerance*(1 + fabs(y[i])));
        sum += scaled*scaled;
    }
    return sqrt(sum/N);
}

/* Their hinit. */
static double first_step(double t, const double *y, const double *k1, double tolerance)
{
    double w[N], k2[N];
    const double value = size_of(y, y, tolerance), slope = size_of(k1, y, tolerance);
    const double h = value < 1e-5 || slope < 1e-5 ? 1e-6 : 0.01*value/slope;
    for (int i = 0; i < N; i++) w[i] = y[i] + h*k1[i];
    MOTION(t + h, w, k2);
    for (int i = 0; i < N; i++) w[i] = k2[i] - k1[i];
    const double steeper = fmax(slope, size_of(w, y, tolerance)/h);
    return fmin(100*h, steeper <= 1e-15 ? fmax(1e-6, 1e-3*h) : pow(0.01/steeper, 1.0/8));
}

/* Takes y from t to end, tolerance absolute and relative; returns how often the motion was evaluated. */
long integrate(double t, double end, double tolerance, double *y)
{
    double k1[N], k2[N], k3[N], k4[N], k5[N], k6[N], k7[N], k8[N], k9[N], k10[N], k11[N], k12[N], w[N];
    double next[N];
    long evaluations = 2;
    int rejected = 0;
    MOTION(t, y, k1);
    double h = first_step(t, y, k1, tolerance);
    while (t < end) {
        const int last = t + 1.01*h >= end;
        if (last) h = end - t;
        STAGES
        double five = 0, three = 0;
        for (int i = 0; i < N; i++) {
            next[i] = y[i] + h*(SOLUTION(i));
            const double scale = tolerance*(1 + fmax(fabs(y[i]), fabs(next[i])));
            const double error5 = (ERROR5(i))/scale, error3 = (ERROR3(i))/scale;
            five += error5*error5;
            three += error3*error3;
        }
        const double error = five == 0 ? 0 : h*five/sqrt((five + 0.01*three)*N);
        const double change = fmin(6, fmax(0.333, 0.9*pow(fmax(error, 1e-30), -1.0/8)));
        evaluations += 11;
        if (error > 1) {
            rejected = 1;
            h *= fmin(1, change);
            continue;
        }
        memcpy(y, next, sizeof next);
        t = last ? end : t + h;
        MOTION(t, y, k1);
        evaluations++;
        h *= rejected ? fmin(1, change) : change;
        rejected = 0;
    }
    return evaluations;
}
