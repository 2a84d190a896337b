// The names that windows.h and its like define as macros.
#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <variant>
#include <vector>

#define min(a, b) (((a) < (b)) ? (a) : (b))
#define max(a, b) (((a) > (b)) ? (a) : (b))
#define near
#define far
#define small char

#include <lightbin/advise.hpp>
#include <lightbin/lightbin.hpp>
#include <lightbin/shader_build.hpp>

lightbin::Binner<> binner;
