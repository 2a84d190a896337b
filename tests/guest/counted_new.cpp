#include "counted_new.hpp"

#include <cstdlib>
#include <new>

std::size_t allocations = 0, allocations_left = 0;
long blocks = 0;

namespace {

void* counted(void* memory) {
    ++allocations;
    const bool fails = allocations_left != 0 && --allocations_left == 0;
    blocks += memory != nullptr && !fails;
    if (memory != nullptr && !fails) return memory;
    std::free(memory);
    throw std::bad_alloc();
}

void uncounted(void* memory) {
    blocks -= memory != nullptr;
    std::free(memory);
}

}  // namespace

// By default the array forms call these; but a sanitizer has array forms of its own.
void* operator new(std::size_t size) {
    return counted(std::malloc(size != 0 ? size : 1));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    const auto unit = static_cast<std::size_t>(alignment);
    return counted(std::aligned_alloc(unit, (size + unit - 1) / unit * unit));
}
void* operator new[](std::size_t size) {
    return operator new(size);
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return operator new(size, alignment);
}
void operator delete(void* memory) noexcept {
    uncounted(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    uncounted(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    uncounted(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    uncounted(memory);
}
void operator delete[](void* memory) noexcept {
    uncounted(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    uncounted(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
    uncounted(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
    uncounted(memory);
}
