// The names that the headers of other libraries define as macros, each as it is there, or so that no use of it could
// compile. (neighbours.sh and microsoft.sh include the headers themselves, of those that are at hand.)
#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <chrono>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

// Windows.
#define min(a, b) (((a) < (b)) ? (a) : (b))
#define max(a, b) (((a) > (b)) ? (a) : (b))
#define near
#define far
#define small char
#define hyper __int64
#define interface struct
#define cdecl
#define pascal
#define IN
#define OUT
#define OPTIONAL
#define CONST const
#define VOID void
#define ERROR 0
#define DELETE 0x00010000
#define DIFFERENCE 11
#define DOMAIN 1
#define NO_ERROR 0
#define OPAQUE 2
#define TRANSPARENT 1
#define ABSOLUTE 1
#define RELATIVE 2
#define STRICT 1
#define IGNORE 0
#define INFINITE 0xFFFFFFFF
#define Yield()
#define CreateWindow CreateWindowW
#define DrawText DrawTextW
#define GetMessage GetMessageW
#define GetObject GetObjectW
#define SendMessage SendMessageW

// X11.
#define None 0L
#define Bool int
#define Status int
#define True 1
#define False 0
#define Success 0
#define Always 2
#define Above 0
#define Below 1
#define Unsorted 0
#define YXBanded 3
#define Complex 0
#define Convex 2
#define Nonconvex 1
#define KeyPress 2
#define FocusIn 9
#define Expose 12
#define CursorShape 0
#define ControlMask (1 << 2)
#define GrayScale 1
#define Opposite 4
#define AllocNone 0
#define CurrentTime 0L
#define Font long

// Qt.
#define signals public
#define slots
#define emit
#define foreach(variable, container) for (variable : container)
#define forever for (;;)
#define Q_SIGNALS public
#define Q_SLOTS
#define Q_EMIT

// Unreal. Apple's headers have some of these, too.
#define check(...) never
#define checkf(...) never
#define verify(...) never
#define verifyf(...) never
#define ensure(...) never
#define require(...) never
#define TEXT(text) L##text
#define UPROPERTY(...) never
#define UFUNCTION(...) never
#define GENERATED_BODY(...) never
#define PI (3.1415926535897932f)
#define INDEX_NONE -1
#define FORCEINLINE
#define RESTRICT
#define LIKELY(x) (x)
#define UNLIKELY(x) (x)
#define dynamic_cast never

// C libraries (complex.h, termios.h, sys/param.h, sys/sysmacros.h), Arduino, and what projects define for themselves.
#define I 1i
#define B0 0
#define B50 1
#define major(x) never
#define minor(x) never
#define isset(...) never
#define howmany(...) never
#define roundup(...) never
#define bit(x) never
#define F(x) never
#define unix 1
#define linux 1
#define TRUE 1
#define FALSE 0
#define DEBUG 1
#define AVX 1
#define AVX2 1
#define FMA 1
#define SSE2 1

#include <lightbin/advise.hpp>
#include <lightbin/budget.hpp>
#include <lightbin/encode.hpp>
#include <lightbin/grid_union.hpp>
#include <lightbin/lightbin.hpp>
#include <lightbin/shader_cull.hpp>
#include <lightbin/shader_reduce.hpp>

lightbin::Binner<> binner;
