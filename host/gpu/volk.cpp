// The one place that compiles volk's definitions.
#define VOLK_IMPLEMENTATION
#include <volk.h>
