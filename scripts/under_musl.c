/* Load a shipped library for Linux as `rocking_cli.dynamics.shipped` does, and print what its kernel of pulses fills in.

       musl-gcc under_musl.c -o under_musl && ./under_musl LIBRARY FUNCTION ...

   The functions are those of C that the library calls. The pulses are two sines on a linear block. */
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>

int main(int count, char **given) {
    void *library = dlopen(given[1], RTLD_NOW), *c = dlopen(0, RTLD_NOW);
    if (!library) return fprintf(stderr, "%s\n", dlerror()), 1;
    for (int k = 2; k < count; k++) {
        char name[64];
        snprintf(name, sizeof name, "rocking_%s", given[k]);
        void **place = dlsym(library, name), *function = dlsym(c, given[k]);
        if (!place || !function) return fprintf(stderr, "%s is missing\n", given[k]), 1;
        *place = function;
    }
    int32_t (*pulses)(int64_t *, double *, int64_t *) = dlsym(library, "rocking_pulses");
    double real[] = {2, 1, 0.5, 0.9, 2, 1, 0.5, 0.9}; /* p, uplift, rate and eta of both sides */
    double segment[] = {0, 1, -1, 6.283185307179586, 0}, amplitudes[] = {1.2, 3}, periods[] = {1, 2}, results[12];
    int64_t whole[] = {1, 5, 2, 2, 0, 2, 2, 6}; /* shapes, and the first and the last pulse */
    int64_t places[] = {(int64_t)segment, (int64_t)amplitudes, (int64_t)periods, (int64_t)results};
    int32_t status = pulses(whole, real, places);
    for (int k = 0; k < 12; k++) printf("%.17g\n", results[k]);
    return status;
}
