// SPDX-License-Identifier: MIT
// Holds a scene's light lists against the exact truth: the filter's proof where it has one, else rationals.
#pragma once

#include "engine.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace oracle {

struct Verdicts {
    std::uint64_t cases = 0;   ///< lights, each in a scene's lists
    std::uint64_t proven = 0;  ///< "the ball does not meet this block of tiles"
    std::uint64_t exact = 0;   ///< of these, decided by rationals
    std::uint64_t misses = 0, strays = 0;
    std::vector<std::string> reports;  ///< the first few, and whatever else was wrong
};

class Judge {
public:
    explicit Judge(const Scene& scene);
    ~Judge();
    Judge(Judge&&) noexcept;

    /// Every light of every rung, `rectangles` first: what it lacks is proven by whole blocks of tiles, and the
    /// others by what they lack of it (a light of theirs that it lacks is a stray).
    void examine(Rung rung, const Lists& lists, Verdicts& verdicts);

    /// Puts random questions to filter and rationals. Returns how many the filter answered; adds those it
    /// answered wrongly to `wrong`.
    std::uint64_t test_filter(Random& random, std::size_t questions, std::uint64_t& wrong);

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// Builds and judges every rung of a scene.
void judge_scene(Scene scene, const Engine& engine, Verdicts& verdicts);

/// One scene of a family: made, built, judged, counted.
void run_scene(const Family& family, std::uint64_t seed, std::size_t lights, const Engine& engine,
               Verdicts& verdicts);

/// Judge::test_filter on a scene of a family.
std::uint64_t test_filter(const Family& family, std::uint64_t seed, std::size_t questions,
                          std::uint64_t& wrong);

}  // namespace oracle
