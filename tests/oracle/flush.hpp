// SPDX-License-Identifier: MIT
// Denormal floats taken for 0, as some programs set their threads.
#pragma once

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace oracle {

/// Sets FTZ and DAZ for its life, where the processor is known to have them.
class Flush {
public:
    explicit Flush(bool on) : before_(get()) {
        if (on) set(before_ | flags);
    }
    ~Flush() { set(before_); }
    Flush(const Flush&) = delete;
    Flush& operator=(const Flush&) = delete;

private:
#if defined(__x86_64__)
    static constexpr unsigned flags = 0x8040;
    static unsigned get() {
        return _mm_getcsr();
    }
    static void set(unsigned value) {
        _mm_setcsr(value);
    }
#else
    static constexpr unsigned flags = 0;
    static unsigned get() {
        return 0;
    }
    static void set(unsigned) {}
#endif
    unsigned before_;
};

}  // namespace oracle
