#include <stdio.h>
#include "@{name}.h"

int main(void)
{
    double t, q[@{NAME}_COORDINATES], v[@{NAME}_COORDINATES], a[@{NAME}_COORDINATES];
    double lambda[@{NAME}_MULTIPLIERS + 1], p[@{NAME}_PARAMETERS + 1], u[3*@{NAME}_CONTROLS + 1] = {0};
    double y[@{NAME}_OUTPUTS + 1];
    @{name}_start(&t, q, v);
    @{name}_values(p);
    @{name}_law(t, p, u);
    @{name}_motion(t, q, v, u, p, a, lambda);
    @{name}_observe(t, q, v, u, p, y);
    for (int s = 0; s < @{NAME}_COORDINATES; s++) printf("ddot(%s) = %.17g\n", @{name}_coordinates[s], a[s]);
    for (int b = 0; b < @{NAME}_MULTIPLIERS; b++) printf("%s = %.17g\n", @{name}_multipliers[b], lambda[b]);
    for (int o = 0; o < @{NAME}_OUTPUTS; o++) printf("%s = %.17g\n", @{name}_outputs[o], y[o]);
    return 0;
}
