// SPDX-License-Identifier: MIT
// DefaultFloatEnvironment: the floating-point environment that threads start with, for the duration of a library call.
// Kernels need it because their error margins are derived for rounding to nearest, and because they divide by zero and
// compare NaN in lanes whose results they ignore, which must not trap.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#if !defined(__wasm__) && (defined(__SSE__) || defined(_M_X64) || (defined(_M_IX86_FP) && _M_IX86_FP > 0))
#if defined(__GNUC__) || defined(__clang__)
#define LIGHTBIN_GET_ENVIRONMENT() __builtin_ia32_stmxcsr()
#define LIGHTBIN_SET_ENVIRONMENT(value) __builtin_ia32_ldmxcsr(value)
#else
#include <xmmintrin.h>
#define LIGHTBIN_GET_ENVIRONMENT() _mm_getcsr()
#define LIGHTBIN_SET_ENVIRONMENT(value) _mm_setcsr(value)
#endif
#elif !defined(__wasm__)
#include <cfenv>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// While an object of this class lives, the thread rounds to nearest, traps nothing and keeps denormal numbers. The
/// destructor restores the caller's environment and exception flags. Both together take about ten nanoseconds.
class DefaultFloatEnvironment {
public:
    DefaultFloatEnvironment(const DefaultFloatEnvironment&) = delete;
    DefaultFloatEnvironment& operator=(const DefaultFloatEnvironment&) = delete;

#if defined(LIGHTBIN_GET_ENVIRONMENT)
    DefaultFloatEnvironment() : callers_(LIGHTBIN_GET_ENVIRONMENT()) {
        constexpr unsigned flags = 0x3f, by_default = 0x1f80;  // all exceptions masked, rounding to nearest
        if ((callers_ & ~flags) != by_default) LIGHTBIN_SET_ENVIRONMENT(by_default);
    }
    ~DefaultFloatEnvironment() { LIGHTBIN_SET_ENVIRONMENT(callers_); }

private:
    unsigned callers_;
#elif defined(__wasm__)
    DefaultFloatEnvironment() {}  // WebAssembly has one fixed environment
    ~DefaultFloatEnvironment() {}
#else
    DefaultFloatEnvironment() {
        std::fegetenv(&callers_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~DefaultFloatEnvironment() { std::fesetenv(&callers_); }

private:
    std::fenv_t callers_;
#endif
};

}}}  // namespace lightbin::detail

#undef LIGHTBIN_GET_ENVIRONMENT
#undef LIGHTBIN_SET_ENVIRONMENT
