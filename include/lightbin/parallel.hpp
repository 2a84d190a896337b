// SPDX-License-Identifier: MIT
// The caller's threads, lent for the time of a call: lightbin has none of its own.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/float_environment.hpp>

#include <cstddef>
#include <type_traits>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// A worker count and the caller's way to run a loop on several threads. Refers to the caller's callable, an object or
/// a function, which must outlive the call that it is given to.
class Parallel {
    struct Body {
        void operator()(std::size_t i) const { call(context, i); }

        const void* context;
        void (*call)(const void* context, std::size_t i);
    };
    union CallersRun {
        void* object;
        void (*function)();
    };

public:
    /// No threads: the work is done by the calling thread.
    Parallel() = default;

    /// workers   how many threads `run` has; more or fewer change the speed, never the result
    /// run       run(n, body) calls body(i), a std::size_t, once for each 0 <= i < n, in any order, on any
    ///           threads, and returns when all calls have returned: tbb::parallel_for, a thread pool, OpenMP.
    ///           A call throws where there is no memory, or what the caller's own functions throw. `run` may
    ///           throw too, that or anything, once no call is under way.
    /// start_ns  about how long it takes until `run` has its threads at work. What would gain less is done by the
    ///           calling thread alone, unless it wakes the threads for what follows. The default is that of
    ///           threads asleep; 0 shares all that can be shared.
    template <class Run>
    Parallel(std::size_t workers, Run&& run, double start_ns = 50000)
        : workers_(workers > 1 ? workers : 1), start_ns_(start_ns) {
        using Function = std::decay_t<Run>;  // a pointer, of a function and of a pointer to one
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

    /// Whether sharing work pays off that takes one thread so long: the gain is at least twice what the start costs.
    bool pays_off(double ns) const {
        const double workers = static_cast<double>(workers_);
        return workers_ > 1 && ns * (workers - 1) >= 2 * start_ns_ * workers;
    }

    /// Calls body(i) for each 0 <= i < n.
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
    double start_ns_ = 0;
    CallersRun run_ = {};
    void (*start_)(CallersRun callers, std::size_t n, Body body) = nullptr;
};

/// No threads to share work among, known at compile time: leaves no code for it.
struct Serial {
    operator Parallel() const { return {}; }
};

}}  // namespace lightbin
