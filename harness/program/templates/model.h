#include "@{name}.h"
#define MODEL(function) @{name}_##function
#define TOKEN "@{token}"
enum { N = @{NAME}_COORDINATES, G = @{NAME}_MULTIPLIERS, M = @{NAME}_CONTROLS, K = @{NAME}_PARAMETERS,
    F = @{NAME}_FOUND_CONTROLS, Y = @{NAME}_OUTPUTS };
