// Read before all else by microsoft.sh, which takes MinGW's C library for Microsoft's: what the one lacks of the other.
#include <_mingw.h>
#undef __MINGW_IMPORT
#define __MINGW_IMPORT extern

#include <math.h>
#undef isfinite
#undef isinf
#undef isnan
inline bool isnan(double x) {
    return x != x;
}
inline bool isfinite(double x) {
    return !isnan(x - x);
}
inline bool isinf(double x) {
    return !isnan(x) && !isfinite(x);
}
#define _strtof_l _strtod_l
#define _strtold_l _strtod_l
