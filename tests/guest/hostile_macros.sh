# hostile_macros: prints a source that includes all of the library behind names that headers of other libraries define
# as macros, each so that no use of it compiles. (neighbours.sh and microsoft.sh include the headers themselves, of those
# that are at hand.) Read by compile.sh.
hostile_macros() {
    # What the library includes of the standard library, which must not be behind the macros.
    printf '#include <%s>\n' algorithm array bit cfloat chrono cmath functional initializer_list limits memory new \
        optional ranges span string string_view tuple variant vector

    # Of Windows; X11; Qt; Unreal and Apple; C libraries, Arduino and projects themselves, in this order.
    printf '#define %s never!\n' \
        near far small hyper interface cdecl pascal IN OUT OPTIONAL CONST VOID ERROR DELETE DIFFERENCE DOMAIN NO_ERROR \
        OPAQUE TRANSPARENT ABSOLUTE RELATIVE STRICT IGNORE INFINITE CreateWindow DrawText GetMessage GetObject \
        SendMessage \
        None Bool Status True False Success Always Above Below Unsorted YXBanded Complex Convex Nonconvex KeyPress \
        FocusIn Expose CursorShape ControlMask GrayScale Opposite AllocNone CurrentTime Font \
        signals slots emit forever Q_SIGNALS Q_SLOTS Q_EMIT \
        PI INDEX_NONE FORCEINLINE RESTRICT dynamic_cast \
        I B0 B50 unix linux TRUE FALSE DEBUG AVX AVX2 FMA SSE2
    printf '#define %s(...) never!\n' min max Yield foreach \
        check checkf verify verifyf ensure require TEXT UPROPERTY UFUNCTION GENERATED_BODY LIKELY UNLIKELY \
        major minor isset howmany roundup bit F

    printf '#include <lightbin/%s.hpp>\n' advise budget dump encode lightbin shader_cull shader_reduce
    echo 'lightbin::Binner<> binner;'
}
