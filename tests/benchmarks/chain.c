/* The planar chain by hand: the limit that the motion program is measured against

   LINKS unit masses on unit links in the plane, the first link of length u. With d_k = r_k - r_(k-1), d_1 = r_1, and
   e_k their rates, the constraints (|d_1|^2 - u^2)/2 = 0 and (|d_k|^2 - 1)/2 = 0 give G lambda = b with

       G_11 = u^2,  G_kk = 2,  G_k(k-1) = -d_k.d_(k-1),
       b_1 = g y_1 + dot(u)^2 + u ddot(u) - |e_1|^2,  b_k = -|e_k|^2,

   which is tridiagonal, and ddot(r_k) = -g e_y + d_k lambda_k - d_(k+1) lambda_(k+1). It uses what holds on the
   constraints alone, |d_k| = 1. Below, s_k = d_k.d_(k-1) = -G_k(k-1) and l_k = s_k/D_(k-1).

   Operations, + - * / each one:
       first mass       |e_1|^2 3, b_1 6, D_1 1                                                       10
       each other mass  d_k 2, e_k 2, s_k 3, l_k 1, D_k 2, |e_k|^2 3, b_k 2                           15
       back, last mass  lambda 1, d lambda 2, ddot(r) 1                                                4
       back, others     lambda 3, d lambda 2, ddot(r) 3                                                8
   In all 10 + 15 (LINKS - 1) + 4 + 8 (LINKS - 1) = 23 LINKS - 9.

   in:  t, x1, y1, ..., dot(x1), dot(y1), ..., u, dot(u), ddot(u)
   out: ddot(x1), ddot(y1), ..., lambda1, ...                                                                  */

#define GRAVITY 9.81

void chain(const double *in, double *out)
{
    const double *x = in + 1, *v = x + 2*LINKS, *u = v + 2*LINKS;
    double *a = out, *lambda = out + 2*LINKS;
    double dx[LINKS], dy[LINKS], l[LINKS], D[LINKS], b[LINKS];

    dx[0] = x[0];
    dy[0] = x[1];
    D[0] = u[0]*u[0];
    b[0] = GRAVITY*x[1] + u[1]*u[1] + u[0]*u[2] - (v[0]*v[0] + v[1]*v[1]);
    for (int k = 1; k < LINKS; k++) {
        const double ex = v[2*k] - v[2*k - 2], ey = v[2*k + 1] - v[2*k - 1];
        dx[k] = x[2*k] - x[2*k - 2];
        dy[k] = x[2*k + 1] - x[2*k - 1];
        const double s = dx[k]*dx[k - 1] + dy[k]*dy[k - 1];
        l[k] = s/D[k - 1];
        D[k] = 2 - l[k]*s;
        b[k] = l[k]*b[k - 1] - (ex*ex + ey*ey);
    }
    double fx = 0, fy = 0;
    for (int k = LINKS - 1; k >= 0; k--) {
        lambda[k] = b[k]/D[k];
        if (k < LINKS - 1) lambda[k] += l[k + 1]*lambda[k + 1];
        const double gx = dx[k]*lambda[k], gy = dy[k]*lambda[k];
        a[2*k] = gx - fx;
        a[2*k + 1] = gy - fy - GRAVITY;
        fx = gx;
        fy = gy;
    }
}
