/* The mathematical functions of the system's C library, for modules that Zig links. Zig's own runtime library has these
 * functions, too, and the linker takes them from there: their last bit is another one. Objects come before libraries,
 * so these definitions are found first; they call the system's, which are looked up when the module is loaded. */
#include <dlfcn.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

/* X(result, name, parameters, arguments) */
#define FUNCTIONS(X)                                        \
  X(double, cos, (double x), (x))                           \
  X(double, exp, (double x), (x))                           \
  X(double, exp2, (double x), (x))                          \
  X(double, fma, (double x, double y, double z), (x, y, z)) \
  X(double, fmod, (double x, double y), (x, y))             \
  X(double, log, (double x), (x))                           \
  X(double, log10, (double x), (x))                         \
  X(double, log2, (double x), (x))                          \
  X(double, sin, (double x), (x))                           \
  X(double, tan, (double x), (x))                           \
  X(float, cosf, (float x), (x))                            \
  X(float, expf, (float x), (x))                            \
  X(float, exp2f, (float x), (x))                           \
  X(float, fmodf, (float x, float y), (x, y))               \
  X(float, logf, (float x), (x))                            \
  X(float, log10f, (float x), (x))                          \
  X(float, log2f, (float x), (x))                           \
  X(float, sinf, (float x), (x))                            \
  X(float, tanf, (float x), (x))

#define DEFINE(result, name, parameters, arguments) \
  static result(*system_##name) parameters;         \
  result name parameters {                          \
    return system_##name arguments;                 \
  }
FUNCTIONS(DEFINE)

static void (*system_sincos)(double, double*, double*);
void sincos(double x, double* sine, double* cosine) {
  system_sincos(x, sine, cosine);
}

static void* look_up(void* library, const char* name) {
  void* const found = library != NULL ? dlsym(library, name) : NULL;
  if (found == NULL) {
    fprintf(stderr, "riffler: the system's libm.so.6 has no %s\n", name);
    abort();
  }
  return found;
}

__attribute__((constructor(101))) static void load(void) {
  void* const library = dlopen("libm.so.6", RTLD_NOW | RTLD_LOCAL);
#define LOAD(result, name, parameters, arguments) *(void**)&system_##name = look_up(library, #name);
  FUNCTIONS(LOAD)
  *(void**)&system_sincos = look_up(library, "sincos");
}
