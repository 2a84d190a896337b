# from_python.py LIBRARY: the C side as another language calls it, by ctypes, which knows nothing but the binary
# interface.
import array
import ctypes as c
import math
import sys

library = c.CDLL(sys.argv[1])


class Result(c.Structure):
    _fields_ = [("error", c.c_int32), ("unused", c.c_int32), ("name", c.c_char_p), ("needed", c.c_uint64),
                ("available", c.c_uint64)]


class Matrix(c.Structure):
    _fields_ = [("floats", c.c_void_p), ("doubles", c.c_void_p), ("layout", c.c_int32), ("unused", c.c_int32)]


class ViewOptions(c.Structure):
    _fields_ = [("size", c.c_uint32), ("width", c.c_int32), ("height", c.c_int32), ("tile_size", c.c_int32),
                ("projection", Matrix), ("clip_depth", c.c_int32), ("origin", c.c_int32), ("reversed_z", c.c_int32),
                ("unused", c.c_int32)]


class Floats(c.Structure):
    _fields_ = [("first", c.c_void_p), ("stride", c.c_size_t)]


class Spheres(c.Structure):
    _fields_ = [("count", c.c_size_t), ("centre", Floats), ("radius", Floats)]


class Spots(c.Structure):
    _fields_ = [("count", c.c_size_t), ("centre", Floats), ("radius", Floats), ("axis", Floats), ("cosine", Floats)]


class Boxes(c.Structure):
    _fields_ = [("count", c.c_size_t), ("centre", Floats), ("radius", Floats), ("box_centre", Floats),
                ("half_axes", Floats), ("taper", Floats)]


class Lights(c.Structure):
    _fields_ = [("size", c.c_uint32), ("unused", c.c_uint32), ("view_matrix", Matrix), ("spheres", Spheres),
                ("spots", Spots), ("boxes", Boxes)]


class Grid(c.Structure):
    _fields_ = [("size", c.c_uint32), ("tiles_x", c.c_int32), ("tiles_y", c.c_int32), ("slices", c.c_int32),
                ("ranges", c.POINTER(c.c_uint32 * 2)), ("ids", c.POINTER(c.c_uint32)), ("range_count", c.c_uint64),
                ("id_count", c.c_uint64), ("id_bytes", c.c_uint32), ("lights", c.c_uint32), ("rejected", c.c_uint32),
                ("culled", c.c_uint32), ("order", c.c_void_p), ("bins", c.c_void_p), ("order_count", c.c_uint64),
                ("bin_count", c.c_uint64), ("first_spot", c.c_uint32), ("first_box", c.c_uint32)]


for name in ("view_create", "binner_create", "bin"):
    getattr(library, "lightbin_" + name).restype = Result


def check(result):
    if result.error != 0:
        text = c.create_string_buffer(512)
        library.lightbin_error_text(result, text, c.c_size_t(512))
        raise ValueError(text.value.decode())


width, height, tile = 320, 160, 16
near, far = 0.1, 100.0
projection = array.array("d", [1, 0, 0, 0, 0, 2, 0, 0, 0, 0, -(far + near) / (far - near), -1, 0, 0,
                               -2 * far * near / (far - near), 0])
view, binner = c.c_void_p(), c.c_void_p()
options = ViewOptions(size=c.sizeof(ViewOptions), width=width, height=height, tile_size=tile,
                      projection=Matrix(doubles=projection.buffer_info()[0]))
check(library.lightbin_view_create(c.byref(options), c.byref(view)))
check(library.lightbin_binner_create(None, c.byref(binner)))

# Small lights straight ahead of pixels: each must be listed in the tile of its pixel, and of all others in no more than
# the eight around that.
count = 200
depth, radius = 10.0, 0.01
pixels = [((37 * i + 5) % width + 0.5, (11 * i * i + 3) % height + 0.5) for i in range(count)]
lights = array.array("f")
for x, y in pixels:
    lights.extend([99, depth * (2 * x / width - 1), depth * (2 * y / height - 1) / 2, -depth, radius, 99])
first, stride = lights.buffer_info()[0], 6 * 4
given = Lights(size=c.sizeof(Lights), spheres=Spheres(count, Floats(first + 4, stride), Floats(first + 16, stride)))
grid = Grid(size=c.sizeof(Grid))
check(library.lightbin_bin(binner, view, c.byref(given), None, c.byref(grid)))
assert (grid.tiles_x, grid.tiles_y, grid.lights, grid.culled) == (20, 10, count, 0)
tiles = [set(grid.ids[offset:offset + length]) for offset, length in (grid.ranges[i] for i in range(grid.range_count))]
for i, (x, y) in enumerate(pixels):
    at = math.floor(y / tile) * grid.tiles_x + math.floor(x / tile)
    assert i in tiles[at], (i, x, y)
    assert sum(i in listed for listed in tiles) <= 9

# An error is the sentence of the library.
grid.size = 5
try:
    check(library.lightbin_bin(binner, view, c.byref(given), None, c.byref(grid)))
    raise SystemExit("a struct of 5 bytes was accepted")
except ValueError as error:
    assert str(error).startswith("grid: `size` must be sizeof of the struct, %d, and is 5" % c.sizeof(Grid)), error

library.lightbin_binner_destroy(binner)
library.lightbin_view_destroy(view)
print("every check passed")
