# SPDX-License-Identifier: MIT
# Shows lightbin's results in gdb, in programs that use libstdc++: `source lightbin/packaging/debugger/lightbin_gdb.py`.
# `print *grid` has a line for each tile that lists lights, [x, y, slice] = {ids}. Masks are shown as the lists that
# they say. The cells of a second view follow those of the first, as more slices.
import struct

import gdb
import gdb.printing


def numbers(span):
    """The elements of a std::span."""
    first = span["_M_ptr"]
    return [first[i] for i in range(int(span["_M_extent"]["_M_extent_value"]))]


class GridPrinter:
    def __init__(self, grid):
        self.grid = grid

    def to_string(self):
        grid = self.grid
        return "lightbin::LightGrid of %d x %d tiles, %d slices, %d entries" % (
            grid["tiles_x_"], grid["tiles_y_"], grid["slices_"], grid["ids_"]["_M_extent"]["_M_extent_value"])

    def children(self):
        columns, rows = int(self.grid["tiles_x_"]), int(self.grid["tiles_y_"])
        ids = self.grid["ids_"]["_M_ptr"]
        for cell, listed in enumerate(numbers(self.grid["ranges_"])):
            offset, count = int(listed["offset"]), int(listed["count"])
            if count:
                place = (cell % columns, cell // columns % rows, cell // columns // rows)
                first = ids[offset]
                yield "[%d, %d, %d]" % place, first.cast(first.type.array(count - 1))


class MasksPrinter:
    def __init__(self, masks):
        self.masks = masks

    def to_string(self):
        return "lightbin::LightMasks of %d x %d tiles, %d z-bins" % (
            self.masks["tiles_x_"], self.masks["tiles_y_"], self.masks["bins_"]["_M_extent"]["_M_extent_value"])

    def children(self):
        columns, rows = int(self.masks["tiles_x_"]), int(self.masks["tiles_y_"])
        words = [int(word) for word in numbers(self.masks["words_"])]
        each = words[0]
        masks = [sum(words[1 + i * each + w] << 32 * w for w in range(each)) for i in range(columns + 1 + rows)]
        ids = words[1 + len(masks) * each:]
        for y in range(rows):
            for x in range(columns):
                both = masks[x] & masks[columns + 1 + y]
                listed = [ids[bit] for bit in range(32 * each) if both >> bit & 1]
                if listed:
                    array = self.masks["words_"]["_M_ptr"].dereference().type.array(len(listed) - 1)
                    yield "[%d, %d]" % (x, y), gdb.Value(struct.pack("=%dI" % len(listed), *listed), array)


printers = gdb.printing.RegexpCollectionPrettyPrinter("lightbin")
printers.add_printer("LightGrid", r"^lightbin::built_for_\w+::LightGrid<.*>$", GridPrinter)
printers.add_printer("LightMasks", r"^lightbin::built_for_\w+::LightMasks$", MasksPrinter)
gdb.printing.register_pretty_printer(gdb.current_objfile(), printers, replace=True)
