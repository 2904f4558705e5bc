/* A library of Holonom as an FMI 3.0 unit for model exchange (FMI specification 3.0.1, sections 2 and 3)

   model.h names the library and counts its variables. Value references, and places in the instance:

       0            time
       Q, V         coordinates and velocities: the continuous states
       U            controls, their first and second time derivatives: inputs
       P            parameters
       DQ, A        the states' derivatives
       LAMBDA       multipliers
       FOUND        controls that servo-constraints find
       OBSERVED     outputs that the scene names

   What lies before STORED is given. The rest is computed on request, once for each state. The initial state is near:
   at the end of the initialization it is projected onto the constraints of these parameters and controls.    */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef void *fmi3Instance;
typedef void *fmi3Environment;
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef const char *fmi3String;
typedef void (*fmi3Callback)(void);
typedef void (*fmi3LogMessageCallback)(fmi3Environment, fmi3Status, fmi3String category, fmi3String message);

enum { Q = 1, V = Q + N, U = V + N, P = U + 3*M, STORED = P + K, DQ = STORED, A = DQ + N, LAMBDA = A + N,
    FOUND = LAMBDA + G, OBSERVED = FOUND + F, ALL = OBSERVED + Y };

typedef struct {
    double x[ALL];
    bool computed;
    fmi3LogMessageCallback log;
    fmi3Environment environment;
} Unit;

static void initialize(Unit *unit)
{
    memset(unit->x, 0, sizeof unit->x);
    unit->computed = false;
    MODEL(start)(unit->x, unit->x + Q, unit->x + V);
    MODEL(values)(unit->x + P);
    MODEL(law)(unit->x[0], unit->x + P, unit->x + U);
}

static void compute(Unit *unit)
{
    double *x = unit->x;
    if (unit->computed) return;
    memcpy(x + DQ, x + V, N*sizeof *x);
    MODEL(motion)(x[0], x + Q, x + V, x + U, x + P, x + A, x + LAMBDA);
    MODEL(servo)(x[0], x + Q, x + V, x + U, x + P, x + FOUND);
    MODEL(observe)(x[0], x + Q, x + V, x + U, x + P, x + OBSERVED);
    unit->computed = true;
}

/* ---- instances and modes -------------------------------------------------------------------------------- */

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

EXPORT fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources, bool visible,
    bool logging, fmi3Environment environment, fmi3LogMessageCallback log)
{
    (void)name, (void)resources, (void)visible, (void)logging;
    if (strcmp(token, TOKEN) != 0) {
        if (log) log(environment, fmi3Error, "logStatusError", "the instantiation token is that of another unit");
        return NULL;
    }
    Unit *unit = malloc(sizeof *unit);
    if (!unit) return NULL;
    unit->log = log;
    unit->environment = environment;
    initialize(unit);
    return unit;
}

EXPORT void fmi3FreeInstance(fmi3Instance unit) { free(unit); }

EXPORT fmi3Status fmi3Reset(fmi3Instance unit)
{
    initialize(unit);
    return fmi3OK;
}

EXPORT fmi3Status fmi3EnterInitializationMode(fmi3Instance unit, bool with_tolerance, double tolerance, double start,
    bool with_stop, double stop)
{
    (void)with_tolerance, (void)tolerance, (void)with_stop, (void)stop;
    ((Unit *)unit)->x[0] = start;
    ((Unit *)unit)->computed = false;
    return fmi3OK;
}

EXPORT fmi3Status fmi3ExitInitializationMode(fmi3Instance instance)
{
    Unit *unit = instance;
    double *x = unit->x;
    unit->computed = false;
    if (MODEL(project)(x[0], x + Q, x + V, x + U, x + P) == 0) return fmi3OK;
    if (unit->log) unit->log(unit->environment, fmi3Error, "logStatusError",
        "no state near the initial one satisfies the constraints; start nearer to one that does");
    return fmi3Error;
}

#define MODE(name) EXPORT fmi3Status fmi3##name(fmi3Instance unit) { (void)unit; return fmi3OK; }
MODE(EnterEventMode)
MODE(EnterContinuousTimeMode)
MODE(EvaluateDiscreteStates)
MODE(Terminate)

EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance unit, bool on, size_t n, const fmi3String categories[])
{
    (void)unit, (void)on, (void)n, (void)categories;
    return fmi3OK;
}

/* ---- variables ------------------------------------------------------------------------------------------ */

EXPORT fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference references[], size_t n,
    double values[], size_t nvalues)
{
    Unit *unit = instance;
    if (n != nvalues) return fmi3Error;
    for (size_t i = 0; i < n; i++) {
        if (references[i] >= ALL) return fmi3Error;
        if (references[i] >= STORED) compute(unit);
        values[i] = unit->x[references[i]];
    }
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference references[], size_t n,
    const double values[], size_t nvalues)
{
    Unit *unit = instance;
    if (n != nvalues) return fmi3Error;
    for (size_t i = 0; i < n; i++)
        if (references[i] == 0 || references[i] >= STORED) return fmi3Error;
    for (size_t i = 0; i < n; i++) unit->x[references[i]] = values[i];
    unit->computed = false;
    return fmi3OK;
}

/* ---- model exchange ------------------------------------------------------------------------------------- */

EXPORT fmi3Status fmi3SetTime(fmi3Instance instance, double time)
{
    Unit *unit = instance;
    unit->x[0] = time;
    unit->computed = false;
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const double states[], size_t n)
{
    Unit *unit = instance;
    if (n != 2*N) return fmi3Error;
    memcpy(unit->x + Q, states, n*sizeof *states);
    unit->computed = false;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetContinuousStates(fmi3Instance unit, double states[], size_t n)
{
    if (n != 2*N) return fmi3Error;
    memcpy(states, ((Unit *)unit)->x + Q, n*sizeof *states);
    return fmi3OK;
}

/* fmi3Discard where a pivot vanishes: the integrator is to take a shorter step. */
EXPORT fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance unit, double derivatives[], size_t n)
{
    if (n != 2*N) return fmi3Error;
    compute(unit);
    memcpy(derivatives, ((Unit *)unit)->x + DQ, n*sizeof *derivatives);
    for (size_t i = 0; i < n; i++)
        if (derivatives[i] - derivatives[i] != 0) return fmi3Discard;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance unit, double nominals[], size_t n)
{
    (void)unit;
    for (size_t i = 0; i < n; i++) nominals[i] = 1;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance unit, size_t *n)
{
    (void)unit;
    *n = 2*N;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance unit, size_t *n)
{
    (void)unit;
    *n = 0;
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetEventIndicators(fmi3Instance unit, double indicators[], size_t n)
{
    (void)unit, (void)indicators;
    return n == 0 ? fmi3OK : fmi3Error;
}

EXPORT fmi3Status fmi3CompletedIntegratorStep(fmi3Instance unit, bool final, bool *enter_event_mode, bool *terminate)
{
    (void)unit, (void)final;
    *enter_event_mode = *terminate = false;
    return fmi3OK;
}

EXPORT fmi3Status fmi3UpdateDiscreteStates(fmi3Instance unit, bool *again, bool *terminate, bool *nominals_changed,
    bool *states_changed, bool *next_event_defined, double *next_event)
{
    (void)unit, (void)next_event;
    *again = *terminate = *nominals_changed = *states_changed = *next_event_defined = false;
    return fmi3OK;
}

/* ---- the state as a whole ------------------------------------------------------------------------------- */

EXPORT fmi3Status fmi3GetFMUState(fmi3Instance unit, fmi3FMUState *state)
{
    if (!*state && !(*state = malloc(sizeof(Unit)))) return fmi3Error;
    memcpy(*state, unit, sizeof(Unit));
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetFMUState(fmi3Instance unit, fmi3FMUState state)
{
    memcpy(unit, state, sizeof(Unit));
    return fmi3OK;
}

EXPORT fmi3Status fmi3FreeFMUState(fmi3Instance unit, fmi3FMUState *state)
{
    (void)unit;
    free(*state);
    *state = NULL;
    return fmi3OK;
}

/* ---- what the unit does not have ------------------------------------------------------------------------ */

#define REFERENCES fmi3Instance unit, const fmi3ValueReference r[], size_t n
#define REFUSED { (void)unit, (void)r; return n == 0 ? fmi3OK : fmi3Error; }
#define NO_VARIABLES(kind, type) \
    EXPORT fmi3Status fmi3Get##kind(REFERENCES, type x[], size_t m) { (void)x, (void)m; { REFUSED } } \
    EXPORT fmi3Status fmi3Set##kind(REFERENCES, const type x[], size_t m) { (void)x, (void)m; { REFUSED } }
NO_VARIABLES(Float32, float)
NO_VARIABLES(Int8, int8_t)
NO_VARIABLES(UInt8, uint8_t)
NO_VARIABLES(Int16, int16_t)
NO_VARIABLES(UInt16, uint16_t)
NO_VARIABLES(Int32, int32_t)
NO_VARIABLES(UInt32, uint32_t)
NO_VARIABLES(Int64, int64_t)
NO_VARIABLES(UInt64, uint64_t)
NO_VARIABLES(Boolean, bool)
NO_VARIABLES(String, fmi3String)

EXPORT fmi3Status fmi3GetBinary(REFERENCES, size_t sizes[], const uint8_t *x[], size_t m)
{ (void)sizes, (void)x, (void)m; REFUSED }
EXPORT fmi3Status fmi3SetBinary(REFERENCES, const size_t sizes[], const uint8_t *const x[], size_t m)
{ (void)sizes, (void)x, (void)m; REFUSED }
EXPORT fmi3Status fmi3GetClock(REFERENCES, bool x[]) { (void)x; REFUSED }
EXPORT fmi3Status fmi3SetClock(REFERENCES, const bool x[]) { (void)x; REFUSED }
EXPORT fmi3Status fmi3GetIntervalDecimal(REFERENCES, double x[], int y[]) { (void)x, (void)y; REFUSED }
EXPORT fmi3Status fmi3GetIntervalFraction(REFERENCES, uint64_t x[], uint64_t y[], int z[])
{ (void)x, (void)y, (void)z; REFUSED }
EXPORT fmi3Status fmi3GetShiftDecimal(REFERENCES, double x[]) { (void)x; REFUSED }
EXPORT fmi3Status fmi3GetShiftFraction(REFERENCES, uint64_t x[], uint64_t y[]) { (void)x, (void)y; REFUSED }
EXPORT fmi3Status fmi3SetIntervalDecimal(REFERENCES, const double x[]) { (void)x; REFUSED }
EXPORT fmi3Status fmi3SetIntervalFraction(REFERENCES, const uint64_t x[], const uint64_t y[])
{ (void)x, (void)y; REFUSED }
EXPORT fmi3Status fmi3SetShiftDecimal(REFERENCES, const double x[]) { (void)x; REFUSED }
EXPORT fmi3Status fmi3SetShiftFraction(REFERENCES, const uint64_t x[], const uint64_t y[])
{ (void)x, (void)y; REFUSED }
EXPORT fmi3Status fmi3GetOutputDerivatives(REFERENCES, const int32_t orders[], double x[], size_t m)
{ (void)orders, (void)x, (void)m; REFUSED }
EXPORT fmi3Status fmi3GetDirectionalDerivative(REFERENCES, const fmi3ValueReference s[], size_t m, const double seed[],
    size_t nseed, double x[], size_t nx)
{ (void)s, (void)m, (void)seed, (void)nseed, (void)x, (void)nx; REFUSED }
EXPORT fmi3Status fmi3GetAdjointDerivative(REFERENCES, const fmi3ValueReference s[], size_t m, const double seed[],
    size_t nseed, double x[], size_t nx)
{ (void)s, (void)m, (void)seed, (void)nseed, (void)x, (void)nx; REFUSED }

EXPORT fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance unit, fmi3ValueReference r, size_t *n)
{ (void)unit, (void)r, (void)n; return fmi3Error; }
EXPORT fmi3Status fmi3GetVariableDependencies(fmi3Instance unit, fmi3ValueReference r, size_t elements[],
    fmi3ValueReference independents[], size_t of_independents[], int kinds[], size_t n)
{ (void)unit, (void)r, (void)elements, (void)independents, (void)of_independents, (void)kinds, (void)n; return fmi3Error; }
EXPORT fmi3Status fmi3SerializedFMUStateSize(fmi3Instance unit, fmi3FMUState state, size_t *size)
{ (void)unit, (void)state, (void)size; return fmi3Error; }
EXPORT fmi3Status fmi3SerializeFMUState(fmi3Instance unit, fmi3FMUState state, uint8_t bytes[], size_t size)
{ (void)unit, (void)state, (void)bytes, (void)size; return fmi3Error; }
EXPORT fmi3Status fmi3DeserializeFMUState(fmi3Instance unit, const uint8_t bytes[], size_t size, fmi3FMUState *state)
{ (void)unit, (void)bytes, (void)size, (void)state; return fmi3Error; }
EXPORT fmi3Status fmi3EnterConfigurationMode(fmi3Instance unit) { (void)unit; return fmi3Error; }
EXPORT fmi3Status fmi3ExitConfigurationMode(fmi3Instance unit) { (void)unit; return fmi3Error; }
EXPORT fmi3Status fmi3EnterStepMode(fmi3Instance unit) { (void)unit; return fmi3Error; }
EXPORT fmi3Status fmi3DoStep(fmi3Instance unit, double at, double step, bool final, bool *event, bool *terminate,
    bool *early, double *last)
{ (void)unit, (void)at, (void)step, (void)final, (void)event, (void)terminate, (void)early, (void)last; return fmi3Error; }
EXPORT fmi3Status fmi3ActivateModelPartition(fmi3Instance unit, fmi3ValueReference clock, double time)
{ (void)unit, (void)clock, (void)time; return fmi3Error; }
EXPORT fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, bool visible,
    bool logging, bool events, bool early, const fmi3ValueReference intermediate[], size_t n, fmi3Environment environment,
    fmi3LogMessageCallback log, fmi3Callback update)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)events, (void)early;
    (void)intermediate, (void)n, (void)environment, (void)log, (void)update;
    return NULL;
}
EXPORT fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
    bool visible, bool logging, fmi3Environment environment, fmi3LogMessageCallback log, fmi3Callback update,
    fmi3Callback lock, fmi3Callback unlock)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)environment, (void)log;
    (void)update, (void)lock, (void)unlock;
    return NULL;
}
