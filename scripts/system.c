/* What a shipped library has beside its kernels: the level of the processor, and what systems call by themselves. */
#ifdef __x86_64__
#include <cpuid.h>

static unsigned leaf(unsigned number, int which) {
    unsigned registers[4] = {0};
    __get_cpuid_count(number, 0, registers, registers + 1, registers + 2, registers + 3);
    return registers[which];
}

static int all(unsigned bits, unsigned wanted) { return (bits & wanted) == wanted; }

/* 4, 3 or 1 as in x86-64-v4: what the processor has, and of which the system saves the registers. */
int rocking_level(void) {
    unsigned saved, high;
    /* fma sse3 ssse3 cx16 sse4.1 sse4.2 movbe popcnt osxsave avx f16c; lahf lzcnt; bmi avx2 bmi2 */
    if (!all(leaf(1, 2), 0x38d83201) || !all(leaf(0x80000001, 2), 0x21) || !all(leaf(7, 1), 0x128)) return 1;
    __asm__("xgetbv" : "=a"(saved), "=d"(high) : "c"(0));
    if (!all(saved, 0x06)) return 1;
    return all(saved, 0xe6) && all(leaf(7, 1), 0xd0030000) ? 4 : 3; /* avx512 f dq cd bw vl */
}
#else
int rocking_level(void) { return 1; }
#endif

#ifdef __APPLE__ /* LLVM calls these instead of memset. */
void *memset(void *, int, unsigned long);
__attribute__((visibility("hidden"))) void bzero(void *to, unsigned long size) { memset(to, 0, size); }
__attribute__((visibility("hidden"))) void __bzero(void *to, unsigned long size) { memset(to, 0, size); }
#endif

#ifdef _WIN32 /* Windows calls this when it loads a library; there is nothing to do. */
int DllMainCRTStartup(void *library, unsigned reason, void *reserved) { return 1; }
#endif
