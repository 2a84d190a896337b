# Makes one C++ file of the blocks of code in pages: awk -f blocks.awk PAGE.md... Each block is a function of its own, but
# for what defines functions, which is a namespace of its own; what it takes for granted is in given.hpp.
BEGIN {
    print "#include \"given.hpp\""
}
/^```cpp$/ {
    inside = 1
    body = "#line " FNR + 1 " \"" FILENAME "\"\n"
    defines = 0
    next
}
/^```/ && inside {
    inside = 0
    ++blocks
    opening = defines ? "namespace block_" blocks " {\n" : "int block_" blocks "() {\n"
    bodies = bodies opening body (defines ? "}\n" : "return 0;\n}\n")
    next
}
inside && /^#include/ {
    if (!seen[$0]++) print
    body = body "\n"
    next
}
inside {
    if (/^extern "C"/) defines = 1
    if (/^(template|struct|void|int|bool) /) defines = defines || /\) \{$/
    body = body $0 "\n"
}
END {
    if (inside || blocks < 20) {
        print "these pages have " blocks + 0 " blocks of code, or one without an end" >"/dev/stderr"
        exit 1
    }
    printf "namespace {\n%s}\nint main() {}\n", bodies
}
