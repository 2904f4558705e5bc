/* @{title}

@{table}
*/

#include <math.h>
#include <stddef.h>

@{helpers}

@{pieces}/* One point: in and out hold its inputs and outputs. */
void motion(const double *in, double *out)
{
@{one}
}

@{lanes}
/* Many points: in[k*points + i] is input k of point i, out[k*points + i] output k. */
void motion_batch(size_t points, const double *in, double *out)
{
    size_t i = 0;
    for (; i + LANES <= points; i += LANES) {
@{many}
    }
    for (; i < points; i++) {
        double values[@{inputs}], results[@{outputs}];
        for (size_t k = 0; k < @{inputs}; k++) values[k] = in[k*points + i];
        motion(values, results);
        for (size_t k = 0; k < @{outputs}; k++) out[k*points + i] = results[k];
    }
}
