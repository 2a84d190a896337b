// SPDX-License-Identifier: MIT
// For lists.cpp: memory that is not cleared holds other bytes with each allocation, so that who takes some of them for
// numbers makes other lists. A file of its own, as compilers warn of an operator that they see through. clang's memory and
// thread sanitizers have operators of their own.
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>

#if defined(__has_feature)
#if __has_feature(memory_sanitizer) || __has_feature(thread_sanitizer)
#define SANITIZER_HAS_NEW
#endif
#endif

#if !defined(SANITIZER_HAS_NEW)
void* operator new(std::size_t size) {
    static unsigned char filling = 0;
    void* const memory = std::malloc(size + 1);
    if (memory == nullptr) std::abort();
    return std::memset(memory, ++filling, size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return operator new(size);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
#endif
