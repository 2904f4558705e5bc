#include <string.h>

#ifdef __GNUC__
#pragma GCC diagnostic ignored "-Wpsabi" /* no lanes are passed from here to code compiled otherwise */
#if defined __AVX512F__
#define WIDTH 64
#elif defined __AVX__
#define WIDTH 32
#else
#define WIDTH 16
#endif
typedef double lanes __attribute__((vector_size(WIDTH))); /* as wide as the registers */
#define LANE(x, k) (x)[k]
#else
typedef double lanes;
#define LANE(x, k) (x)
#endif
enum { LANES = sizeof(lanes)/sizeof(double) };

#define EACH_LANE(x, value) lanes x; for (int k = 0; k < LANES; k++) LANE(x, k) = (value); return x
static inline lanes lanes_of(double number) { EACH_LANE(y, number); }
static inline lanes lanes_at(const double *from) { lanes x; memcpy(&x, from, sizeof x); return x; }
static inline void put_lanes(double *to, lanes x) { memcpy(to, &x, sizeof x); }
static inline lanes lanes_square(lanes x) { return x*x; }
static inline lanes lanes_cube(lanes x) { return x*x*x; }
