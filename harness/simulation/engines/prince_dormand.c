/* A motion by the explicit Runge-Kutta method of Prince and Dormand, 8(7) in 13 stages

   J. Comput. Appl. Math. 7 (1981) 67; the GNU Scientific Library takes the steps. Before this text prince_dormand.py
   puts the number STATE of coordinates and velocities, and the functions of t and the state

       accelerations                               and, where the constraints are to be kept,
       position_corrections, velocity_corrections  with the number PROJECTED of steps after which the state is
                                                   moved to them, or with Baumgarte's cure or Gear's (GGL), which
                                                   add to the rates so that what is missed dies out like
                                                   exp(-GAMMA t).                                              */

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#define MARGIN 0.8
#define LEAST_GROWTH 0.2
#define MOST_GROWTH 5.0

enum { COORDINATES = STATE/2 };

struct follower {
    double t, *state;               /* where the motion has come                                       */
    double until;                   /* where it goes                                                   */
    double last;                    /* length of the last step                                         */
    double shortest, longest;       /* of the steps taken, without the one that reached `until`        */
    long most, taken;               /* steps                                                           */
    double *instants, *states;      /* filled with the start of each step, unless they are NULL        */
};

long evaluations;
static double tolerance;
static double reached = NAN, left[STATE], step;   /* where the last steps led, and how long the next would be */
static gsl_odeiv2_step *method;
static gsl_odeiv2_control *control;
static gsl_odeiv2_evolve *evolution;

/* Comparisons, which a processor makes side by side. */
static int are_finite(int count, const double *x)
{
    int others = 0;
    for (int i = 0; i < count; i++) others |= !(fabs(x[i]) <= DBL_MAX);
    return !others;
}

/* d and e of stabilization.py, added to the rates. */
static void cure_drift(double t, const double *state, double *out)
{
#ifdef GAMMA
    double position[COORDINATES], velocity[COORDINATES];
    position_corrections(t, state, position);
    velocity_corrections(t, state, velocity);
    for (int i = 0; i < COORDINATES; i++) {
#ifdef BAUMGARTE
        out[COORDINATES + i] += 2*GAMMA*velocity[i] + GAMMA*GAMMA*position[i];
#else
        out[i] += GAMMA*position[i];
        out[COORDINATES + i] += GAMMA*velocity[i];
#endif
    }
#endif
    (void)t, (void)state, (void)out;
}

static int rates(double t, const double *state, double *out, void *unused)
{
    (void)unused;
    memcpy(out, state + COORDINATES, COORDINATES*sizeof *out);
    accelerations(t, state, out + COORDINATES);
    cure_drift(t, state, out);
    evaluations++;
    return are_finite(STATE, out) ? GSL_SUCCESS : GSL_FAILURE;
}

static const gsl_odeiv2_system motion = { rates, NULL, STATE, NULL };

/* Quadratic mean of numbers, each against the tolerance of its place in the state. */
static double size_of(const double *x, const double *state)
{
    double sum = 0;
    for (int i = 0; i < STATE; i++) {
        const double scaled = x[i]/(tolerance*(1 + fabs(state[i])));
        sum += scaled*scaled;
    }
    return sqrt(sum/STATE);
}

/* Each step is as long as the error of the one before allows (Hairer, Norsett & Wanner I, section II.4), with a margin
   that lets next to none fail. GSL's own control leaves a step alone while the error is between half the tolerance and
   all of it; a seventh of the steps of a chain fail then. */
static int adjust_step(void *unused, size_t size, unsigned order, const double *state, const double *errors,
                       const double *slope, double *length)
{
    (void)unused, (void)size, (void)slope;
    const double error = size_of(errors, state);
    *length *= fmin(MOST_GROWTH, fmax(LEAST_GROWTH, MARGIN*pow(error, -1.0/order)));
    return error <= 1 ? GSL_ODEIV_HADJ_NIL : GSL_ODEIV_HADJ_DEC;
}

static void *what_it_knows(void) { return &tolerance; }

static const gsl_odeiv2_control_type every_step = { "every step", what_it_knows, NULL, adjust_step, NULL, NULL, NULL };

/* Returns 0, or GSL's number for what went wrong. */
int begin(double relative_and_absolute_tolerance)
{
    gsl_set_error_handler_off();
    tolerance = relative_and_absolute_tolerance;
    method = gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk8pd, STATE);
    control = gsl_odeiv2_control_alloc(&every_step);
    evolution = gsl_odeiv2_evolve_alloc(STATE);
    return method && control && evolution ? GSL_SUCCESS : GSL_ENOMEM;
}

/* Forget the rates at the last state, which is another one now. */
static void begin_anew(void)
{
    gsl_odeiv2_evolve_reset(evolution);
    gsl_odeiv2_step_reset(method);
}

/* Hairer, Norsett & Wanner I, section II.4, for a method of order 8. */
static double first_step(double t, const double *state)
{
    double slope[STATE], later[STATE], other[STATE];
    if (rates(t, state, slope, NULL)) return DBL_EPSILON;
    const double value = size_of(state, state), speed = size_of(slope, state);
    const double h = value < 1e-5 || speed < 1e-5 ? 1e-6 : 0.01*value/speed;
    for (int i = 0; i < STATE; i++) later[i] = state[i] + h*slope[i];
    if (rates(t + h, later, other, NULL)) return h;
    for (int i = 0; i < STATE; i++) other[i] -= slope[i];
    const double steepest = fmax(speed, size_of(other, state)/h);
    return fmin(100*h, steepest <= 1e-15 ? fmax(1e-6, 1e-3*h) : pow(0.01/steepest, 1.0/9));
}

/* One step of Newton's method for the position, then one for the velocity at the new position. */
static void keep_constraints(double t, double *state)
{
#ifdef PROJECTED
    double change[COORDINATES];
    position_corrections(t, state, change);
    for (int i = 0; i < COORDINATES; i++) state[i] += change[i];
    velocity_corrections(t, state, change);
    for (int i = 0; i < COORDINATES; i++) state[COORDINATES + i] += change[i];
    begin_anew();
#endif
    (void)t, (void)state;
}

/* Takes the steps that are asked for; returns 0, or GSL's number for what ended them before. */
int advance(struct follower *f)
{
    const int moved = f->t != reached || memcmp(f->state, left, sizeof left) != 0;
    f->taken = 0;
    f->shortest = HUGE_VAL;
    f->longest = 0;
    begin_anew();
    if (moved) step = first_step(f->t, f->state);
    while (f->t < f->until && f->taken < f->most) {
        if (f->instants) {
            f->instants[f->taken] = f->t;
            memcpy(f->states + f->taken*STATE, f->state, sizeof left);
        }
        const int failure = gsl_odeiv2_evolve_apply(
            evolution, control, method, &motion, &f->t, f->until, &step, f->state);
        if (failure) return failure;
        f->taken++;
        f->last = evolution->last_step;
        if (f->t < f->until) {
            f->shortest = fmin(f->shortest, f->last);
            f->longest = fmax(f->longest, f->last);
        }
#ifdef PROJECTED
        if (f->taken % PROJECTED == 0) keep_constraints(f->t, f->state);
#endif
    }
    keep_constraints(f->t, f->state);
    reached = f->t;
    memcpy(left, f->state, sizeof left);
    if (are_finite(STATE, left)) return GSL_SUCCESS;
    f->t = NAN;
    return GSL_FAILURE;
}

/* Takes a state to an instant not far from its own, in as many steps as that needs. */
int go_between(double t, double instant, double *state)
{
    double stride = instant - t;
    begin_anew();
    while (t < instant) {
        const int failure = gsl_odeiv2_evolve_apply(evolution, control, method, &motion, &t, instant, &stride, state);
        if (failure) return failure;
    }
    return GSL_SUCCESS;
}
