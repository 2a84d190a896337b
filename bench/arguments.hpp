// SPDX-License-Identifier: MIT
// A report's command line: options, and the .glb files to run on.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

class Arguments {
public:
    Arguments(int argc, char** argv) : words_(argv + 1, argv + argc) {}

    /// Returns whether an option was on the command line, and takes it away.
    bool take(std::string_view option) { return std::erase(words_, option) > 0; }

    /// The value of an option, which stands behind its "=" or is the next word; or `otherwise`. Takes both away.
    std::string take(std::string_view option, std::string otherwise) {
        const auto at = std::ranges::find_if(
            words_, [&](const std::string& word) { return word.substr(0, word.find('=')) == option; });
        if (at == words_.end()) return otherwise;
        const std::size_t value = at->find('=');
        if (value == std::string::npos && at + 1 == words_.end())
            throw std::runtime_error(std::string(option) + " needs a value");
        otherwise = value == std::string::npos ? at[1] : at->substr(value + 1);
        words_.erase(at, at + (value == std::string::npos ? 2 : 1));
        return otherwise;
    }

    /// What is left when all options are taken.
    const std::vector<std::string>& scenes() const { return words_; }

    /// Returns the scenes named on the command line or, if there are none, those of bench/scenes.
    std::vector<std::string> scenes_or_fixtures() const {
        return words_.empty()
                   ? std::vector<std::string>{LIGHTBIN_SCENES "/nova.glb", LIGHTBIN_SCENES "/darkness.glb",
                                              LIGHTBIN_SCENES "/bart-robots-924.glb"}
                   : words_;
    }

private:
    std::vector<std::string> words_;
};
