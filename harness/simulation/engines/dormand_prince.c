/* A motion by the explicit Runge-Kutta method of Dormand and Prince, 8(5,3) in 12 stages

   Hairer, Norsett & Wanner I, section II.10; coefficients as in SciPy's DOP853. Before this text runge_kutta.py puts
   the number STATE of coordinates and velocities, and the functions of t and the state

       accelerations                               and, for the projection onto the constraints,
       position_corrections, velocity_corrections  with the number PROJECTED of steps after which the state is
                                                   moved to them, or with Baumgarte's or Gear's (GGL) terms, which
                                                   add to the time derivatives of the state so that residuals decay like
                                                   exp(-GAMMA t).                                                */

#include <float.h>

#define MARGIN 0.8
#define LEAST_GROWTH 0.333
#define MOST_GROWTH 6.0

enum { COORDINATES = STATE/2, ROWS = 8 };     /* of dense output: the state at its beginning, and seven coefficients */

struct follower {
    double t, *state;               /* where the motion has come                                       */
    double until;                   /* where it goes                                                   */
    double last;                    /* length of the last step                                         */
    double shortest, longest;       /* of the steps taken, without the one that reached `until`; the   */
                                    /* shortest of those that are shorter than the one before          */
    double usual;                   /* the longest of quiet steps since the motion began anew          */
    long most, taken;               /* steps                                                           */
    double *times;                  /* filled with the start of each step, and                         */
    double (*dense)[ROWS][STATE];   /* with its dense output, unless they are NULL                     */
};

long evaluations;
double longest_step;
static double tolerance;
static double nominal_time, nominal[STATE];       /* sizes that the tolerance is relative to, too                   */
static double estimated;                          /* error of the last step, one where it is all that is allowed  */
static double reached = NAN, left[STATE], step;   /* where the last steps led, and how long the next would be */
static double slope[STATE];                       /* time derivatives at the last state, where they are known                */
static int slope_known;

/* Comparisons, which a processor makes side by side. */
static int are_finite(int count, const double *x)
{
    int others = 0;
    for (int i = 0; i < count; i++) others |= !(fabs(x[i]) <= DBL_MAX);
    return !others;
}

/* d and e of stabilization.py, added to the time derivatives of the state. */
static void stabilize(double t, const double *state, double *out)
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
    stabilize(t, state, out);
    evaluations++;
}

/* Returns whether the time derivatives are not finite. */
static int rates(double t, const double *state, double *out)
{
    evaluate(t, state, out);
    return !are_finite(STATE, out);
}

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

#define STAGE(number, fraction, sum) \
    for (int i = 0; i < STATE; i++) w[i] = y[i] + h*(sum); \
    evaluate(t + fraction*h, w, k##number);

/* One step, from time derivatives k1 to time derivatives k13. A stage that is not finite makes the solution, and its time derivatives, not finite either:
   returns whether they are. A step that succeeds has dense output of order 7, unless it is NULL. */
static int take_step(double t, double h, double *y, const double *k1, double *k13, double (*dense)[STATE])
{
    h = (t + h) - t;    /* as far as the time then is: far from zero it is rounded by much of a short step */
    double k2[STATE], k3[STATE], k4[STATE], k5[STATE], k6[STATE], k7[STATE], k8[STATE], k9[STATE], k10[STATE];
    double k11[STATE], k12[STATE], w[STATE], after[STATE], five = 0, three = 0;
    STAGE(2, 0.05260015195876773, 0.05260015195876773*k1[i])
    STAGE(3, 0.0789002279381516, 0.0197250569845379*k1[i] + 0.0591751709536137*k2[i])
    STAGE(4, 0.1183503419072274, 0.02958758547680685*k1[i] + 0.08876275643042054*k3[i])
    STAGE(5, 0.2816496580927726, 0.2413651341592667*k1[i] - 0.8845494793282861*k3[i] + 0.924834003261792*k4[i])
    STAGE(6, 0.3333333333333333, 0.037037037037037035*k1[i] + 0.17082860872947386*k4[i] + 0.12546768756682242*k5[i])
    STAGE(7, 0.25, 0.037109375*k1[i] + 0.17025221101954405*k4[i] + 0.06021653898045596*k5[i] - 0.017578125*k6[i])
    STAGE(8, 0.3076923076923077, 0.03709200011850479*k1[i] + 0.17038392571223998*k4[i] + 0.10726203044637328*k5[i]
          - 0.015319437748624402*k6[i] + 0.008273789163814023*k7[i])
    STAGE(9, 0.6512820512820513, 0.6241109587160757*k1[i] - 3.3608926294469414*k4[i] - 0.868219346841726*k5[i]
          + 27.59209969944671*k6[i] + 20.154067550477894*k7[i] - 43.48988418106996*k8[i])
    STAGE(10, 0.6, 0.47766253643826434*k1[i] - 2.4881146199716677*k4[i] - 0.590290826836843*k5[i]
          + 21.230051448181193*k6[i] + 15.279233632882423*k7[i] - 33.28821096898486*k8[i] - 0.020331201708508627*k9[i])
    STAGE(11, 0.8571428571428571, -0.9371424300859873*k1[i] + 5.186372428844064*k4[i] + 1.0914373489967295*k5[i]
          - 8.149787010746927*k6[i] - 18.52006565999696*k7[i] + 22.739487099350505*k8[i] + 2.4936055526796523*k9[i]
          - 3.0467644718982196*k10[i])
    STAGE(12, 1.0, 2.273310147516538*k1[i] - 10.53449546673725*k4[i] - 2.0008720582248625*k5[i]
          - 17.9589318631188*k6[i] + 27.94888452941996*k7[i] - 2.8589982771350235*k8[i] - 8.87285693353063*k9[i]
          + 12.360567175794303*k10[i] + 0.6433927460157636*k11[i])
    for (int i = 0; i < STATE; i++) {
        after[i] = y[i] + h*(0.054293734116568765*k1[i] + 4.450312892752409*k6[i] + 1.8915178993145003*k7[i]
            - 5.801203960010585*k8[i] + 0.3111643669578199*k9[i] - 0.1521609496625161*k10[i]
            + 0.20136540080403034*k11[i] + 0.04471061572777259*k12[i]);
        const double scale = tolerance*(nominal[i] + fmax(fabs(y[i]), fabs(after[i])));
        const double error5 = (0.01312004499419488*k1[i] - 1.2251564463762044*k6[i] - 0.4957589496572502*k7[i]
            + 1.6643771824549864*k8[i] - 0.35032884874997366*k9[i] + 0.3341791187130175*k10[i]
            + 0.08192320648511571*k11[i] - 0.022355307863886294*k12[i])/scale;
        const double error3 = (-0.18980075407240762*k1[i] + 4.450312892752409*k6[i] + 1.8915178993145003*k7[i]
            - 5.801203960010585*k8[i] - 0.4226823213237919*k9[i] - 0.1521609496625161*k10[i]
            + 0.20136540080403034*k11[i] + 0.02265179219836082*k12[i])/scale;
        five += error5*error5;
        three += error3*error3;
    }
    estimated = five == 0 ? 0 : h*five/sqrt((five + 0.01*three)*STATE);
    const int failed = rates(t + h, after, k13);
    if (dense && !failed && estimated <= 1) {
        double k14[STATE], k15[STATE], k16[STATE];
        STAGE(14, 0.1, 0.056167502283047954*k1[i] + 0.25350021021662483*k7[i] - 0.2462390374708025*k8[i]
              - 0.12419142326381637*k9[i] + 0.15329179827876568*k10[i] + 0.00820105229563469*k11[i]
              + 0.007567897660545699*k12[i] - 0.008298*k13[i])
        STAGE(15, 0.2, 0.03183464816350214*k1[i] + 0.028300909672366776*k6[i] + 0.053541988307438566*k7[i]
              - 0.05492374857139099*k8[i] - 0.00010834732869724932*k11[i] + 0.0003825710908356584*k12[i]
              - 0.00034046500868740456*k13[i] + 0.1413124436746325*k14[i])
        STAGE(16, 0.7777777777777778, -0.42889630158379194*k1[i] - 4.697621415361164*k6[i] + 7.683421196062599*k7[i]
              + 4.06898981839711*k8[i] + 0.3567271874552811*k9[i] - 0.0013990241651590145*k13[i]
              + 2.9475147891527724*k14[i] - 9.15095847217987*k15[i])
        for (int i = 0; i < STATE; i++) {
            dense[0][i] = y[i];
            dense[1][i] = after[i] - y[i];
            dense[2][i] = h*k1[i] - dense[1][i];
            dense[3][i] = dense[1][i] - h*k13[i] - dense[2][i];
            dense[4][i] = h*(-8.428938276109013*k1[i] + 0.5667149535193777*k6[i] - 3.0689499459498917*k7[i]
                + 2.38466765651207*k8[i] + 2.117034582445028*k9[i] - 0.871391583777973*k10[i]
                + 2.2404374302607883*k11[i] + 0.6315787787694688*k12[i] - 0.08899033645133331*k13[i]
                + 18.148505520854727*k14[i] - 9.194632392478356*k15[i] - 4.436036387594894*k16[i]);
            dense[5][i] = h*(10.427508642579134*k1[i] + 242.28349177525817*k6[i] + 165.20045171727028*k7[i]
                - 374.5467547226902*k8[i] - 22.113666853125306*k9[i] + 7.733432668472264*k10[i]
                - 30.674084731089398*k11[i] - 9.332130526430229*k12[i] + 15.697238121770845*k13[i]
                - 31.139403219565178*k14[i] - 9.35292435884448*k15[i] + 35.81684148639408*k16[i]);
            dense[6][i] = h*(19.985053242002433*k1[i] - 387.0373087493518*k6[i] - 189.17813819516758*k7[i]
                + 527.8081592054236*k8[i] - 11.57390253995963*k9[i] + 6.8812326946963*k10[i]
                - 1.0006050966910838*k11[i] + 0.7777137798053443*k12[i] - 2.778205752353508*k13[i]
                - 60.19669523126412*k14[i] + 84.32040550667716*k15[i] + 11.99229113618279*k16[i]);
            dense[7][i] = h*(-25.69393346270375*k1[i] - 154.18974869023643*k6[i] - 231.5293791760455*k7[i]
                + 357.6391179106141*k8[i] + 93.40532418362432*k9[i] - 37.45832313645163*k10[i]
                + 104.0996495089623*k11[i] + 29.8402934266605*k12[i] - 43.53345659001114*k13[i]
                + 96.32455395918828*k14[i] - 39.17726167561544*k15[i] - 149.72683625798564*k16[i]);
        }
    }
    memcpy(y, after, sizeof after);
    return failed;
}

/* One step as long as the error of the one before allows (Hairer, Norsett & Wanner I, section II.4), with a margin that
   lets next to none fail; shorter ones where it fails. Sets the length of the next one, unless the time ends this one.
   Returns the length of the step, zero where none succeeds. */
static double go_on(double *t, double until, double *length, double *y, double (*dense)[STATE])
{
    const double begun = *t;
    double h = fmin(*length, longest_step), before[STATE], after[STATE];
    memcpy(before, y, sizeof before);
    if (!slope_known && rates(begun, y, slope)) return 0;
    for (;;) {
        const int last = h > until - begun;
        if (last) h = until - begun;
        const int failed = take_step(begun, h, y, slope, after, dense);
        const double next = failed ? 0.5*h : h*fmin(MOST_GROWTH, fmax(LEAST_GROWTH, MARGIN*pow(estimated, -1.0/8)));
        if (!failed && estimated <= 1) {
            *t = last ? until : begun + h;
            if (!last) *length = next;
            memcpy(slope, after, sizeof slope);
            slope_known = 1;
            return h;
        }
        if (!(next < h) || begun + next == begun) return 0;
        memcpy(y, before, sizeof before);
        h = next;
    }
}

void begin(double relative_tolerance, double time, const double *sizes)
{
    tolerance = relative_tolerance;
    nominal_time = time;
    memcpy(nominal, sizes, sizeof nominal);
}

/* Hairer, Norsett & Wanner I, section II.4, for a method of order 8. */
static double first_step(double t, const double *state)
{
    double here[STATE], later[STATE], other[STATE];
    if (rates(t, state, here)) return DBL_EPSILON;
    const double value = size_of(state, state), speed = size_of(here, state);
    const double h = value < 1e-5 || speed*nominal_time < 1e-5 ? 1e-6*nominal_time : 0.01*value/speed;
    for (int i = 0; i < STATE; i++) later[i] = state[i] + h*here[i];
    if (rates(t + h, later, other)) return h;
    for (int i = 0; i < STATE; i++) other[i] -= here[i];
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

/* Takes the steps that are asked for; returns whether one fails. */
static int follow(struct follower *f)
{
    const int moved = f->t != reached || memcmp(f->state, left, sizeof left) != 0;
    f->taken = 0;
    f->shortest = HUGE_VAL;
    f->longest = 0;
    slope_known = 0;
    if (moved) {
        step = first_step(f->t, f->state);
        f->last = 0;
    }
    while (f->t < f->until && f->taken < f->most) {
        if (f->times) f->times[f->taken] = f->t;
        const double before = f->last;
        const double taken = go_on(&f->t, f->until, &step, f->state, f->dense ? f->dense[f->taken] : NULL);
        if (!(taken > 0)) {
            reached = NAN;      /* the next step is not as short, wherever the motion continues */
            return 1;
        }
        f->taken++;
        f->last = taken;
        if (f->t < f->until) {
            if (f->last < before) f->shortest = fmin(f->shortest, f->last);
            f->longest = fmax(f->longest, f->last);
        }
#ifdef PROJECTED
        if (f->taken % PROJECTED == 0) {
            keep_constraints(f->t, f->state);
            slope_known = 0;
        }
#endif
    }
    keep_constraints(f->t, f->state);
    if (tolerance*tolerance > DBL_EPSILON) keep_constraints(f->t, f->state);   /* what is left is of second order */
    reached = f->t;
    memcpy(left, f->state, sizeof left);
    if (are_finite(STATE, left)) return 0;
    f->t = NAN;
    return 1;
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
