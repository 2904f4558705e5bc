/* A motion by the explicit Runge-Kutta method of Dormand and Prince, 8(5,3) in 12 stages

   Hairer, Norsett & Wanner I, section II.10; the GNU Scientific Library leads from step to step. Before this text
   runge_kutta.py puts the number STATE of coordinates and velocities, and the functions of t and the state

       accelerations                               and, where the constraints are to be kept,
       position_corrections, velocity_corrections  with the number PROJECTED of steps after which the state is
                                                   moved to them, or with Baumgarte's cure or Gear's (GGL), which
                                                   add to the rates so that what is missed dies out like
                                                   exp(-GAMMA t);

   and the method's coefficients, each sum over stages written out for component i:

       STAGES        from t, h, y, k1 to k2 ... k12, by way of w, each by one call of evaluate
       SOLUTION(i)   the weights of the solution
       ERROR5(i), ERROR3(i)   those of its errors of order 5 and 3                                              */

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#define MARGIN 0.8
#define LEAST_GROWTH 0.333
#define MOST_GROWTH 6.0

enum { COORDINATES = STATE/2 };

struct follower {
    double t, *state;               /* where the motion has come                                       */
    double until;                   /* where it goes                                                   */
    double last;                    /* length of the last step                                         */
    double shortest, longest;       /* of the steps taken, without the one that reached `until`; the   */
                                    /* shortest of those that are shorter than the one before          */
    double usual;                   /* the longest of quiet steps since the motion began anew          */
    long most, taken;               /* steps                                                           */
    double *instants, *states;      /* filled with the start of each step, unless they are NULL        */
};

long evaluations;
static double tolerance;
static double nominal_time, nominal[STATE];       /* sizes that the tolerance is relative to, too                   */
static double estimated;                          /* error of the last step, one where it is all that is allowed  */
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

static void evaluate(double t, const double *state, double *out)
{
    memcpy(out, state + COORDINATES, COORDINATES*sizeof *out);
    accelerations(t, state, out + COORDINATES);
    cure_drift(t, state, out);
    evaluations++;
}

static int rates(double t, const double *state, double *out, void *unused)
{
    (void)unused;
    evaluate(t, state, out);
    return are_finite(STATE, out) ? GSL_SUCCESS : GSL_FAILURE;
}

static const gsl_odeiv2_system motion = { rates, NULL, STATE, NULL };

/* Quadratic mean of numbers, each against the tolerance of its place in the state. */
static double size_of(const double *x, const double *state)
{
    double sum = 0;
    for (int i = 0; i < STATE; i++) {
        const double scaled = x[i]/(tolerance*(nominal[i] + fabs(state[i])));
        sum += scaled*scaled;
    }
    return sqrt(sum/STATE);
}

/* One step. A stage that is not finite makes the solution, and its rates, not finite either. */
static int take_step(void *unused, size_t size, double t, double h, double *y, double *errors, const double *k1,
                     double *k13, const gsl_odeiv2_system *system)
{
    (void)unused, (void)size, (void)system;
    h = (t + h) - t;    /* as far as the time then is: far from zero it is rounded by much of a short step */
    double k2[STATE], k3[STATE], k4[STATE], k5[STATE], k6[STATE], k7[STATE], k8[STATE], k9[STATE], k10[STATE];
    double k11[STATE], k12[STATE], w[STATE], five = 0, three = 0;
    STAGES
    for (int i = 0; i < STATE; i++) {
        w[i] = y[i] + h*(SOLUTION(i));
        const double scale = tolerance*(nominal[i] + fmax(fabs(y[i]), fabs(w[i])));
        const double error5 = (ERROR5(i))/scale, error3 = (ERROR3(i))/scale;
        five += error5*error5;
        three += error3*error3;
    }
    memcpy(y, w, sizeof w);
    estimated = five == 0 ? 0 : h*five/sqrt((five + 0.01*three)*STATE);
    memset(errors, 0, sizeof w);    /* GSL has room for one estimate; adjust_step goes by what is made of both */
    return rates(t + h, y, k13, NULL);
}

static void *no_room(size_t size) { (void)size; return &tolerance; }
static int nothing_to_forget(void *unused, size_t size) { (void)unused, (void)size; return GSL_SUCCESS; }
static unsigned order(void *unused) { (void)unused; return 8; }
static void nothing_to_free(void *unused) { (void)unused; }

static const gsl_odeiv2_step_type dormand_prince = {
    "Dormand and Prince 8(5,3)", 1, 1, no_room, take_step, NULL, nothing_to_forget, order, nothing_to_free};

/* Each step is as long as the error of the one before allows (Hairer, Norsett & Wanner I, section II.4), with a margin
   that lets next to none fail. GSL's own control leaves a step alone while the error is between half the tolerance and
   all of it; a seventh of the steps of a chain fail then. */
static int adjust_step(void *unused, size_t size, unsigned order, const double *state, const double *errors,
                       const double *slope, double *length)
{
    (void)unused, (void)size, (void)state, (void)errors, (void)slope;
    *length *= fmin(MOST_GROWTH, fmax(LEAST_GROWTH, MARGIN*pow(estimated, -1.0/order)));
    return estimated <= 1 ? GSL_ODEIV_HADJ_NIL : GSL_ODEIV_HADJ_DEC;
}

static void *what_it_knows(void) { return &tolerance; }

static const gsl_odeiv2_control_type every_step = {
    "every step", what_it_knows, NULL, adjust_step, NULL, NULL, nothing_to_free};

/* Returns 0, or GSL's number for what went wrong. */
int begin(double relative_tolerance, double time, const double *sizes)
{
    gsl_set_error_handler_off();
    tolerance = relative_tolerance;
    nominal_time = time;
    memcpy(nominal, sizes, sizeof nominal);
    method = gsl_odeiv2_step_alloc(&dormand_prince, STATE);
    control = gsl_odeiv2_control_alloc(&every_step);
    evolution = gsl_odeiv2_evolve_alloc(STATE);
    return method && control && evolution ? GSL_SUCCESS : GSL_ENOMEM;
}

void end(void)
{
    gsl_odeiv2_evolve_free(evolution);
    gsl_odeiv2_control_free(control);
    gsl_odeiv2_step_free(method);
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
    const double h = value < 1e-5 || speed*nominal_time < 1e-5 ? 1e-6*nominal_time : 0.01*value/speed;
    for (int i = 0; i < STATE; i++) later[i] = state[i] + h*slope[i];
    if (rates(t + h, later, other, NULL)) return h;
    for (int i = 0; i < STATE; i++) other[i] -= slope[i];
    const double steep = nominal_time*fmax(speed, nominal_time*size_of(other, state)/h);
    return fmin(100*h, steep <= 1e-15 ? fmax(1e-6*nominal_time, 1e-3*h) : nominal_time*pow(0.01/steep, 1.0/9));
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
#endif
    (void)t, (void)state;
}

/* Takes the steps that are asked for; returns 0, or GSL's number for what ended them before. */
static int follow(struct follower *f)
{
    const int moved = f->t != reached || memcmp(f->state, left, sizeof left) != 0;
    f->taken = 0;
    f->shortest = HUGE_VAL;
    f->longest = 0;
    begin_anew();
    if (moved) {
        step = first_step(f->t, f->state);
        f->last = 0;
    }
    while (f->t < f->until && f->taken < f->most) {
        if (f->instants) {
            f->instants[f->taken] = f->t;
            memcpy(f->states + f->taken*STATE, f->state, sizeof left);
        }
        const double before = f->last;
        const int failure = gsl_odeiv2_evolve_apply(
            evolution, control, method, &motion, &f->t, f->until, &step, f->state);
        if (failure) return failure;
        f->taken++;
        f->last = evolution->last_step;
        if (f->t < f->until) {
            if (f->last < before) f->shortest = fmin(f->shortest, f->last);
            f->longest = fmax(f->longest, f->last);
        }
#ifdef PROJECTED
        if (f->taken % PROJECTED == 0) {
            keep_constraints(f->t, f->state);
            begin_anew();
        }
#endif
    }
    keep_constraints(f->t, f->state);
    if (tolerance*tolerance > DBL_EPSILON) keep_constraints(f->t, f->state);   /* what is left is of second order */
    reached = f->t;
    memcpy(left, f->state, sizeof left);
    if (are_finite(STATE, left)) return GSL_SUCCESS;
    f->t = NAN;
    return GSL_FAILURE;
}

/* The same for those outside; inside, the C library's old advance() could be called in its place. */
int advance(struct follower *f) { return follow(f); }

/* As advance, where no step fails, or is SHRUNK times shorter than the longest since the motion began anew. Returns the
   number of steps; 0 where the motion is left as it was, to be watched. */
long advance_quietly(struct follower *f, double until, long most)
{
    const double begun = f->t;
    double state[STATE];
    memcpy(state, f->state, sizeof state);
    if (begun != reached || memcmp(state, left, sizeof state) != 0) f->usual = 0;
    f->until = until;
    f->most = most;
    const int failure = follow(f);
    const double usual = fmax(f->usual, f->longest);
    if (!failure && f->shortest*SHRUNK >= usual) {
        f->usual = usual;
        return f->taken;
    }
    f->t = begun;
    memcpy(f->state, state, sizeof state);
    return 0;
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
