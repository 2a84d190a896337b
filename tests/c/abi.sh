#!/bin/sh
# abi.sh LIBRARY [write]: the functions of LIBRARY, a shared library of the C side, and the values and layouts of
# lightbin.h are those of abi.txt: what was published never changes. With `write`, abi.txt is written anew, for what is
# added. For processors with 64 bits.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
header=$here/../../include/lightbin/lightbin.h
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The structs and enums of the header, as a program that prints their layouts and values. Comments are taken out first.
python3 - "$header" >"$work/layouts.c" <<'END'
import re, sys
text = re.sub(r"/\*.*?\*/", "", open(sys.argv[1]).read(), flags=re.S)
print("#include <lightbin/lightbin.h>\n#include <stdio.h>\nint main(void) {")
for name, body in re.findall(r"typedef struct (\w+) \{(.*?)\} \1;", text, re.S):
    print(f'printf("struct {name}: %zu bytes\\n", sizeof({name}));')
    for declaration in body.split(";"):
        for member in re.findall(r"(\w+)(?:\[\d+\])?\s*(?:,|$)", declaration.strip()):
            print(f'printf("  %zu %s, %zu bytes\\n", offsetof({name}, {member}), "{member}", sizeof((({name}*)0)->{member}));')
for name, body in re.findall(r"typedef enum (\w+) \{(.*?)\} \1;", text, re.S):
    print(f'printf("enum {name}\\n");')
    for value in re.findall(r"(LIGHTBIN_\w+)\s*=", body):
        print(f'printf("  {value} = %d\\n", (int){value});')
print("return 0; }")
END
cc -std=c99 -I "$here/../../include" "$work/layouts.c" -o "$work/layouts"
{
    nm -D --defined-only "$1" | sed -n 's/^[^ ]* T \(lightbin_\)/function \1/p' | LC_ALL=C sort
    "$work/layouts"
} >"$work/abi.txt"
[ "$(grep -c '^function' "$work/abi.txt")" -gt 35 ]
[ "$(grep -c '^struct' "$work/abi.txt")" -gt 25 ]
if [ "${2-}" = write ]; then
    cp "$work/abi.txt" "$here/abi.txt"
else
    diff "$here/abi.txt" "$work/abi.txt"
fi

# Errors that a call of contract.c is refused with are among those that the comment of its function lists, or that the
# header's conventions give to all functions; and every error is listed somewhere. The enums have the
# names and numbers of those of C++. Each member of a struct of options is read.
python3 - "$header" "$here/contract.c" "$here"/../../include/lightbin/*.hpp "$here"/../../include/lightbin/detail/c/*.hpp <<'END'
import re, sys
header, contract, *cpp = (open(name).read() for name in sys.argv[1:])
cpp = re.sub("//.*", "", "".join(cpp))
names = re.findall(r"(LIGHTBIN_\w+) *=", re.search(r"typedef enum lightbin_error \{(.*?)\}", header, re.S).group(1))
def named(text):
    found = {name for name in re.findall(r"LIGHTBIN_\w+", text) if name in names}
    for first, last in re.findall(r"(LIGHTBIN_\w+) to\s+(?:\* )?(LIGHTBIN_\w+)", text):
        found.update(names[names.index(first):names.index(last)])
    return found
of_all = named(header[:header.index("*/", header.index("Conventions that hold"))])
listed, comment = {}, ""
for text, function in re.findall(r"/\*(.*?)\*/|LIGHTBIN_API[^;]*?(lightbin_\w+)\(", header, re.S):
    if function:
        errors = comment.partition("Errors")[2]
        others = re.findall(r"those of (lightbin_\w+)\(", errors)
        listed[function] = named(errors).union(*(listed[other] for other in others))
    else:
        comment = text
in_cpp_alone = set(re.findall(r"(LIGHTBIN_\w+) = \d+, +/\* in C\+\+ alone", header))
wrong = [name for name in names[1:-1] if name not in of_all.union(in_cpp_alone, *listed.values())]
calls = 0
for check in re.findall(r"CHECK\((.*?)\);", contract, re.S):  # null arguments any function may refuse
    call = re.search(r"(lightbin_\w+)\(.*?(?:==|\),)\s*(LIGHTBIN_\w+)", check, re.S)
    if call and call.group(2) in names[1:]:
        calls += 1
        if call.group(2) not in of_all | listed[call.group(1)]: wrong.append(call.group(1) + ": " + call.group(2))
assert calls > 45, calls
assert not wrong, wrong
plain = re.sub(r"/\*.*?\*/", "", header, flags=re.S)
in_cpp = []
for body in re.findall(r"enum class \w+ : std::uint8_t \{(.*?)\}", cpp, re.S):
    values, number = {}, -1
    for value, given in re.findall(r"(\w+)(?: = (\d+))?", body):
        number = int(given or number + 1)
        values[value] = number
    in_cpp.append(values)
in_c_alone = {*names[:names.index("LIGHTBIN_MATRIX_NOT_FINITE")], names[-1]}
for name, body in re.findall(r"typedef enum lightbin_(\w+) \{(.*?)\}", plain, re.S):
    values = [value for value in re.findall(r"(\w+) = (\d+)", body) if value[0] not in in_c_alone]
    bare = {re.sub("^lightbin_(resource_|cull_)?", "", value.lower()).replace("no_slicing", "none"): int(number)
            for value, number in values}
    assert bare in in_cpp, (name, bare)
for name, body in re.findall(r"typedef struct lightbin_(\w+_options|format|depth_buffer) \{(.*?)\} lightbin_\1;", plain, re.S):
    for member in re.findall(r"(\w+)\s*(?=[,;])", body):
        assert member in ("size", "unused") or re.search(rf"(given\.|structs\.|MEMBER\(){member}\b", cpp), member
END

# Each function that the header declares is there.
grep -o 'LIGHTBIN_API [^;]*lightbin_[a-z0-9_]*(' "$header" | grep -o 'lightbin_[a-z0-9_]*($' | tr -d '(' | LC_ALL=C sort >"$work/declared"
sed -n 's/^function //p' "$work/abi.txt" | diff "$work/declared" -

# examples/python/lightbin.py reads these values and layouts from the header.
python3 -B - "$1" "$header" "$here" <<'END'
import ctypes, re, sys
library, header, here = sys.argv[1:]
sys.path.insert(0, here + "/../../examples/python")
from lightbin import Library
lib = Library(library, header)
agreed = 0
for line in open(here + "/abi.txt"):
    if found := re.match(r"struct (\w+): (\d+) bytes", line):
        struct = lib.kinds[found[1]]
        assert ctypes.sizeof(struct) == int(found[2]), line
    elif found := re.match(r"  (\d+) (\w+), (\d+) bytes", line):
        field = getattr(struct, found[2])
        assert (field.offset, field.size) == (int(found[1]), int(found[3])), line
    elif found := re.match(r"  LIGHTBIN_(\w+) = (\d+)", line):
        assert lib.values[found[1]] == int(found[2]), line
    agreed += found is not None
assert agreed > 400, agreed
END
