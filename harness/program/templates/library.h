/* @{title}

@{explanation}
*/

#ifndef @{NAME}_H
#define @{NAME}_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

@{enumerations}

/* Names, each list ended by NULL. */
extern const char *const @{name}_coordinates[];
extern const char *const @{name}_multipliers[];
extern const char *const @{name}_controls[];
extern const char *const @{name}_found_controls[];
extern const char *const @{name}_parameters[];
extern const char *const @{name}_outputs[];

/* The scene's start: time, coordinates, velocities; NAN where they depend on a parameter without value. */
void @{name}_start(double *t, double *q, double *v);

/* The scene's values of the parameters; NAN for those to which it gives none. */
void @{name}_values(double *p);

/* The control law with its time derivatives: @{law}. Other controls are left as they are. */
void @{name}_law(double t, const double *p, double *u);

/* Accelerations a and multipliers lambda; infinite or NAN where a pivot vanishes, which is outside the range above. */
void @{name}_motion(double t, const double *q, const double *v, const double *u, const double *p,
    double *a, double *lambda);

/* The same for many points: number k of point i stands at [k*points + i]. */
void @{name}_motion_batch(size_t points, const double *t, const double *q, const double *v, const double *u,
    const double *p, double *a, double *lambda);

/* Residuals f of the constraints and their time derivatives df/dt. */
void @{name}_residual(double t, const double *q, const double *v, const double *u, const double *p,
    double *f, double *rate);

/* Constraint Jacobian df/dq, row by row: J[beta*@{NAME}_COORDINATES + s]. */
void @{name}_jacobian(double t, const double *q, const double *v, const double *u, const double *p, double *J);

/* Controls that servo-constraints find, and the motion above has: @{found}. */
void @{name}_servo(double t, const double *q, const double *v, const double *u, const double *p, double *found);

/* Outputs y that the scene names: @{outputs}. */
void @{name}_observe(double t, const double *q, const double *v, const double *u, const double *p, double *y);

/* Project a state in place onto position and velocity constraints, in the mass metric. Returns 0; or 1 where Newton's
   method does not converge, and then the state is left as it was. */
int @{name}_project(double t, double *q, double *v, const double *u, const double *p);

#ifdef __cplusplus
}
#endif

#endif
