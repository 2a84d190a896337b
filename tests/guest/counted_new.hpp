// Replaces the program's operator new by one that counts, and that can be made to fail.
#pragma once

#include <cstddef>

/// How often it was called.
extern std::size_t allocations;

/// The number of calls up to the one that throws std::bad_alloc; 0 if none shall throw.
extern std::size_t allocations_left;

/// How many blocks of memory are allocated and not yet freed.
extern long blocks;
