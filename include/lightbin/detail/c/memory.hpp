// SPDX-License-Identifier: MIT
// The memory of the C side: each call sets the allocator of its handle for the thread, and Buffers take memory from it.
// The file that implements lightbin.h includes this header before all others of the library. So its Buffers, and by
// LIGHTBIN_ABI_TAG all that holds them, are types of their own, and the C++ side has no allocator to look up.
#pragma once

#if defined(LIGHTBIN_ABI_TAG)
#error                                                                                                       \
    "lightbin: include lightbin.h first of lightbin's headers in the file that defines LIGHTBIN_IMPLEMENTATION"
#endif

#include <lightbin/lightbin.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

/// Buffers allocate by lightbin::c::allocate(), and the inline namespace of the library has a name of its own.
#define LIGHTBIN_CALLERS_MEMORY 1

namespace lightbin {
namespace c {

/// The functions that memory is taken from and given back to.
class Memory {
public:
    /// allocator  null, or with null functions: malloc() and free()
    explicit Memory(const lightbin_allocator* allocator = nullptr) {
        if (allocator != nullptr) caller_ = *allocator;
    }
    /// Whether the caller gave both functions or neither.
    bool complete() const { return (caller_.allocate != nullptr) == (caller_.release != nullptr); }
    void* allocate(std::size_t bytes) const {
        return caller_.allocate != nullptr ? caller_.allocate(caller_.user, bytes) : std::malloc(bytes);
    }
    void release(void* memory) const {
        if (memory == nullptr) return;
        if (caller_.allocate != nullptr)
            caller_.release(caller_.user, memory);
        else
            std::free(memory);
    }

private:
    lightbin_allocator caller_ = {};
};

/// The memory of the call that this thread is in; null outside of calls, where Buffers use malloc() and free().
static thread_local const Memory* memory_of_thread = nullptr;

/// Makes the Buffers of this thread use `memory` until the end of the scope. Calls may be nested: a callback of the
/// program, such as lightbin_threads::run, may call the library for another handle.
class MemoryOfCall {
public:
    explicit MemoryOfCall(const Memory& memory) : before_(memory_of_thread) { memory_of_thread = &memory; }
    ~MemoryOfCall() { memory_of_thread = before_; }
    MemoryOfCall(const MemoryOfCall&) = delete;
    MemoryOfCall& operator=(const MemoryOfCall&) = delete;

private:
    const Memory* before_;
};

[[noreturn]] inline void throw_out_of_memory() {
#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
    throw std::bad_alloc();
#else
    std::abort();
#endif
}

/// Returns the memory that Buffers of this thread use.
inline Memory current_memory() {
    return memory_of_thread != nullptr ? *memory_of_thread : Memory();
}

/// Returns memory for `count` objects of `each` bytes. Throws std::bad_alloc if there is none.
inline void* allocate(std::size_t count, std::size_t each) {
    const std::size_t most = ~std::size_t{0} / 2 / each;
    void* const memory = count > most ? nullptr : current_memory().allocate(count * each);
    if (memory == nullptr) throw_out_of_memory();
    return memory;
}

/// Gives back what allocate() returned, or a null pointer, under the same memory_of_thread.
inline void release(void* memory) {
    current_memory().release(memory);
}

}  // namespace c
}  // namespace lightbin
