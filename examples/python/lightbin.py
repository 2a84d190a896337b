# SPDX-License-Identifier: MIT
"""lightbin in Python by ctypes: structs, values and functions are read from lightbin.h, not written down again."""
import ctypes
import re


class Library:
    def __init__(self, library, header):
        text = re.sub(r"/\*.*?\*/", "", open(header).read(), flags=re.S)
        self.functions = ctypes.CDLL(library)
        self.values = {name: int(value, 0) for name, value in re.findall(r"LIGHTBIN_(\w+) = (\w+)", text)}
        kinds = {"int32_t": ctypes.c_int32, "uint32_t": ctypes.c_uint32, "uint64_t": ctypes.c_uint64,
                 "size_t": ctypes.c_size_t, "float": ctypes.c_float, "double": ctypes.c_double}
        for name, body in re.findall(r"typedef struct (\w+) \{(.*?)\} \1;", text, re.S):
            fields = []
            for kind, members in re.findall(r"(?:const )?(\w+\*?) ([^;]+);", body):
                for pointer, member, length in re.findall(r"(\*?)(\w+)(?:\[(\d+)\])?", members):
                    field = ctypes.c_void_p if pointer or kind.endswith("*") else kinds[kind]
                    fields.append((member, field * int(length) if length else field))
            kinds[name] = type(name, (ctypes.Structure,), {"_fields_": fields})
        self.kinds = kinds
        kinds = {**kinds, "const char*": ctypes.c_char_p, "const float*": ctypes.c_void_p}
        for kind, name in re.findall(r"LIGHTBIN_API ((?:const )?\w+\*?) (lightbin_\w+)\(", text):
            getattr(self.functions, name).restype = kinds.get(kind, ctypes.c_int32)

    def struct(self, name, **members):
        """A struct with its size set, as lib.struct("view_options", width=640)."""
        kind = self.kinds["lightbin_" + name]
        return kind(ctypes.sizeof(kind), **members) if kind._fields_[0][0] == "size" else kind(**members)

    def call(self, name, *arguments):
        """Calls a function, which gets the addresses of structs. A call that is refused raises lightbin's sentence."""
        given = [ctypes.byref(each) if isinstance(each, ctypes.Structure) else each for each in arguments]
        result = getattr(self.functions, "lightbin_" + name)(*given)
        if isinstance(result, self.kinds["lightbin_result"]) and result.error != self.values["OK"]:
            text = ctypes.create_string_buffer(512)
            self.functions.lightbin_error_text(result, text, ctypes.c_size_t(len(text)))
            raise ValueError(text.value.decode())
        return result

    def create(self, name, *arguments):
        """Makes a handle by the function of this name, whose last parameter it is."""
        handle = ctypes.c_void_p()
        self.call(name, *arguments, ctypes.byref(handle))
        return handle
