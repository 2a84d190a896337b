// SPDX-License-Identifier: MIT
// Floating-point settings of the processor that a user's program may have changed, as far as a platform has them.
#pragma once

#include <cfenv>
#include <cstdint>

enum class Rounding { to_nearest, upward, downward, towards_zero };

struct Setting {
    const char* name;
    Rounding rounding = Rounding::to_nearest;
    bool traps = false;    ///< invalid operations and divisions by zero end the program
    bool flushes = false;  ///< denormal numbers are 0, both as operands and as results
};

inline constexpr Setting settings[] = {{"rounding upward", Rounding::upward},
                                       {"rounding downward", Rounding::downward},
                                       {"rounding towards zero", Rounding::towards_zero},
                                       {"trapping", Rounding::to_nearest, true},
                                       {"flushing denormal numbers", Rounding::to_nearest, false, true}};

/// While an object of this class lives, the thread computes in a floating-point environment of the list above.
class Environment {
public:
    explicit Environment(const Setting& setting) : had_(std::fegetenv(&before_) == 0) {
#if defined(__x86_64__) || defined(__i386__)
        vectors_before_ = __builtin_ia32_stmxcsr();
#endif
        set_rounding(setting.rounding);
#if defined(__x86_64__) || defined(__i386__)
        // The bits of the two traps in MXCSR, and those that flush denormal results and operands.
        const unsigned of_default = __builtin_ia32_stmxcsr();
        __builtin_ia32_ldmxcsr((setting.traps ? of_default & ~0x280u : of_default) |
                               (setting.flushes ? 0x8040u : 0));
#elif defined(__aarch64__)
        std::uint64_t control;
        __asm__ volatile("mrs %0, fpcr" : "=r"(control));
        control |=
            (setting.traps ? 0x300u : 0) | (setting.flushes ? 0x1000000u : 0);  // few processors can trap
        __asm__ volatile("msr fpcr, %0" : : "r"(control));
#endif
    }
    ~Environment() {
        if (had_) std::fesetenv(&before_);
#if defined(__x86_64__) || defined(__i386__)
        __builtin_ia32_ldmxcsr(vectors_before_);  // MinGW's fesetenv() leaves this register as it is
#endif
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

private:
    static void set_rounding([[maybe_unused]] Rounding rounding) {
        switch (rounding) {
#if defined(FE_UPWARD)
        case Rounding::upward:
            std::fesetround(FE_UPWARD);
            break;
#endif
#if defined(FE_DOWNWARD)
        case Rounding::downward:
            std::fesetround(FE_DOWNWARD);
            break;
#endif
#if defined(FE_TOWARDZERO)
        case Rounding::towards_zero:
            std::fesetround(FE_TOWARDZERO);
            break;
#endif
        default:
            break;
        }
    }

#if defined(__x86_64__) || defined(__i386__)
    unsigned vectors_before_;
#endif
    std::fenv_t before_;
    bool had_;
};
