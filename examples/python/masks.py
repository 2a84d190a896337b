# SPDX-License-Identifier: MIT
"""python3 masks.py LIBRARY HEADER: masks of 1,000 lights by lightbin's shared library. Points inside of each light are
projected here, too: the tile of each must have the light."""
import ctypes
import math
import random
import sys

from lightbin import Library

width, height, tile, near, far, turn, count = 640, 360, 32, 0.1, 200, 0.4, 1000
projection = (ctypes.c_float * 16)(1, 0, 0, 0, 0, width / height, 0, 0,  # by columns, as OpenGL has matrices
                                   0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0)
camera = (ctypes.c_float * 16)(math.cos(turn), 0, math.sin(turn), 0, 0, 1, 0, 0,
                               -math.sin(turn), 0, math.cos(turn), 0, 0, -4, -30, 1)
random.seed(1)
lights = (ctypes.c_float * 4 * count)()
for light in lights:  # the centre in the world, and the range
    light[:] = random.uniform(-40, 40), random.uniform(0, 3), random.uniform(-40, 40), random.uniform(1, 4)


def make(lib):
    """Returns the view, and the masks with the binner that holds their memory."""
    first, matrix = ctypes.addressof(lights), lib.kinds["lightbin_matrix"]
    view = lib.create("view_create", lib.struct("view_options", width=width, height=height, tile_size=tile,
                                                projection=matrix(ctypes.addressof(projection))))
    spheres = lib.struct("spheres", count=count, centre=(first, 16), radius=(first + 12, 16))
    given = lib.struct("lights", view_matrix=matrix(ctypes.addressof(camera)), spheres=spheres)
    binner, masks = lib.create("binner_create", None), lib.struct("masks")
    lib.call("bin_masks", binner, view, given, None, masks)
    return view, masks, binner


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    masks = make(Library(*sys.argv[1:]))[1]
    words = (ctypes.c_uint32 * masks.word_count).from_address(masks.words)
    ids = (ctypes.c_uint32 * masks.id_count).from_address(masks.ids)
    column = [words[1 + x * masks.mask_words:][:masks.mask_words] for x in range(masks.tiles_x)]
    row = [words[1 + (masks.tiles_x + 1 + y) * masks.mask_words:][:masks.mask_words] for y in range(masks.tiles_y)]
    tiles = [[{light for i, light in enumerate(ids) if (column[x][i // 32] & row[y][i // 32]) >> i % 32 & 1}
              for x in range(masks.tiles_x)] for y in range(masks.tiles_y)]
    seen = missing = 0
    for light, (*centre, reach) in enumerate(lights):
        for _ in range(200):
            way = [random.gauss(0, 1) for _ in range(3)]
            point = [c + w * 0.9999 * reach / math.hypot(*way) for c, w in zip(centre, way)]
            x, y, z = (sum(camera[4 * k + axis] * (point + [1])[k] for k in range(4)) for axis in range(3))
            px, py = (1 - x / z) * width / 2, (1 - y / z * width / height) * height / 2
            if near < -z < far and 0 <= px < width and 0 <= py < height:
                seen += 1
                missing += light not in tiles[int(py / tile)][int(px / tile)]
    mean = sum(len(lit) for line in tiles for lit in line) / (masks.tiles_x * masks.tiles_y)
    print(f"{count} lights, {masks.id_count} in view, {mean:.0f} a tile; {seen} points in view, {missing} missing")
    sys.exit(seen < 10000 or missing > 0 or mean > count / 10)
