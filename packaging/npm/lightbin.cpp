// SPDX-License-Identifier: MIT
// The WebAssembly module of the npm package: the C side without what build.sh leaves out, and the module's memory.
#define LIGHTBIN_IMPLEMENTATION
#include <lightbin/binner.hpp>
#include <lightbin/box.hpp>
#include <lightbin/spot.hpp>

// What no light and no tile goes through is compiled for size alone.
#pragma clang attribute push(__attribute__((minsize)), apply_to = function)
#include <lightbin/lightbin.h>
#pragma clang attribute pop

#include "layouts.inl"

#include <cstddef>

extern "C" {

// Throws in JavaScript, through the functions of the module that were called. The Buffers of the handle are then as
// usable as after a C++ exception, which the module is compiled without.
__attribute__((import_module("env"), import_name("out_of_memory"), noreturn)) void out_of_memory();

void* emscripten_builtin_malloc(std::size_t bytes);
void emscripten_builtin_free(void* memory);

static int live = 0;

/// Returns how many blocks of memory are allocated and not freed.
int live_allocations() {
    return live;
}

void* malloc(std::size_t bytes) {
    void* const memory = emscripten_builtin_malloc(bytes);
    if (memory == nullptr) out_of_memory();
    ++live;
    return memory;
}

void free(void* memory) {
    live -= memory != nullptr;
    emscripten_builtin_free(memory);
}

}  // extern "C"
