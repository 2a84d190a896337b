// SPDX-License-Identifier: MIT
// The WebAssembly module of the npm package: the C side without what build.sh leaves out, and the module's memory.
#define LIGHTBIN_IMPLEMENTATION
#include <lightbin/detail/kinds/shape_kernels.hpp>

// All but the kernels is compiled for size alone.
#pragma clang attribute push(__attribute__((minsize)), apply_to = function)
#include <lightbin/lightbin.h>
#pragma clang attribute pop

#include "layouts.inl"

#include <cstddef>

extern "C" {

// JavaScript has these, so that the module needs no tables of logarithms. They serve slices and texts, but no light.
#define LIGHTBIN_OF_MATH(name) __attribute__((import_module("Math"), import_name(#name)))
LIGHTBIN_OF_MATH(atan) double math_atan(double a);
LIGHTBIN_OF_MATH(log2) double math_log2(double a);
LIGHTBIN_OF_MATH(pow) double math_pow(double base, double exponent);
double atan(double a) {
    return math_atan(a);
}
double log2(double a) {
    return math_log2(a);
}
double pow(double base, double exponent) {
    return math_pow(base, exponent);
}

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
