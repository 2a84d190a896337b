// SPDX-License-Identifier: MIT
// Stability: settled.
// Lets a call use the caller's threads. lightbin starts no threads of its own.
#pragma once

#include <lightbin/detail/base/float_environment.hpp>

#include <cstddef>
#include <type_traits>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// The caller's function for running a loop on several threads, and how many threads it uses. The function is not
/// copied: it must outlive the call that the Parallel is passed to. Work is shared however little there is: pass a
/// Parallel where that pays, from about 100,000 lights on (docs/threads.md).
class Parallel {
    /// The loop body passed to the caller's function: a type-erased callable of an index.
    struct Body {
        void operator()(std::size_t i) const { call(context, i); }

        const void* context;
        void (*call)(const void* context, std::size_t i);
    };
    /// The caller's function object or function, without its type. A function pointer does not fit in a void*.
    union CallersRun {
        void* object;
        void (*function)();
    };

public:
    /// Does all work on the calling thread.
    Parallel() = default;

    /// workers  the number of threads that `run` uses. A wrong number costs speed, but never changes the result.
    /// run      run(n, body) must call body(i) once for each std::size_t i from 0 to n - 1, in any order and on any
    ///          threads, and return when all calls have returned: by tbb::parallel_for, a thread pool, OpenMP. body(i)
    ///          throws if memory runs out or a function of the caller throws. `run` may throw once no body is running.
    template <class Run> Parallel(std::size_t workers, Run&& run) : workers_(workers > 1 ? workers : 1) {
        using Function = std::decay_t<Run>;  // a function decays to a pointer to it
        if constexpr (std::is_function_v<std::remove_pointer_t<Function>>) {
            run_.function = reinterpret_cast<void (*)()>(Function(run));
            start_ = [](CallersRun callers, std::size_t n, Body body) {
                reinterpret_cast<Function>(callers.function)(n, body);
            };
        } else {
            static_assert(
                std::is_lvalue_reference_v<Run>,
                "lightbin: a Parallel refers to `run`, and this one is gone after the expression: give it a "
                "name that lives on");
            using Callable = std::remove_reference_t<Run>;
            run_.object = &reinterpret_cast<char&>(const_cast<std::remove_cv_t<Callable>&>(run));
            start_ = [](CallersRun callers, std::size_t n, Body body) {
                (*static_cast<Callable*>(callers.object))(n, body);
            };
        }
    }

    std::size_t workers() const { return workers_; }

    /// Calls body(i) for each i from 0 to n - 1: by the caller's function, or on the calling thread if there is none.
    template <class Function> void run(std::size_t n, const Function& body) const {
        const auto call = [](const void* context, std::size_t i) {
            const detail::DefaultFloatEnvironment environment;
            (*static_cast<const Function*>(context))(i);
        };
        if (start_ != nullptr && n > 1) return start_(run_, n, Body{&body, call});
        for (std::size_t i = 0; i < n; ++i)
            body(i);
    }

private:
    std::size_t workers_ = 1;
    CallersRun run_ = {};
    void (*start_)(CallersRun callers, std::size_t n, Body body) = nullptr;
};

namespace detail {

/// Does all work on the calling thread, which is known at compile time, so that no code for sharing work is compiled.
struct Serial {
    operator Parallel() const { return {}; }
};

}  // namespace detail

}}  // namespace lightbin
