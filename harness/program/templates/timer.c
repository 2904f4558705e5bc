/* Seconds that one call of a compiled function takes, measured without Python between the calls. */

#define _POSIX_C_SOURCE 199309L
#include <time.h>

typedef void function(const double *in, double *out);

double seconds_a_call(function *f, const double *in, double *out, long calls)
{
    struct timespec start, end;
    clock_gettime(CLOCK_MONOTONIC, &start);
    for (long i = 0; i < calls; i++) f(in, out);
    clock_gettime(CLOCK_MONOTONIC, &end);
    return ((end.tv_sec - start.tv_sec) + 1e-9*(end.tv_nsec - start.tv_nsec))/calls;
}
