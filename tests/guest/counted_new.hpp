// The global operator new of the program, counted, and made to fail.
#pragma once

#include <cstddef>

/// How often it was called.
extern std::size_t allocations;

/// Counts down to the call that throws std::bad_alloc; 0: none does.
extern std::size_t allocations_left;

/// How many blocks of memory it has given that are not freed.
extern long blocks;
