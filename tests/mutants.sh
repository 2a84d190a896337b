#!/bin/sh
# sh tests/mutants.sh [NUMBER...]: can the proof fail? Breaks a line of the library at a time, each as somebody might by
# mistake, builds a proof with it, and expects that to complain. Some ten minutes on two cores. In build/mutants is what
# each proof said; with NUMBERs those mutants alone.
set -eu
me=tests/mutants.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "numbers of mutants" "[1-9][0-9]*|--one" "$@"
work=build/mutants

# mutant PROOF FILE EXPRESSION: sed's EXPRESSION breaks include/lightbin/FILE, and the PROOF must see it: families (every
# rung, tier and number of workers against the exact judge and each other), cells, world, clusters, spots
# or least_spheres.
list() {
    # Rounding outward.
    mutant cells detail/project/projection.hpp 's/float_above(0x1p-20 \* (abs_of(axis.offset) + axis.tiles) + 0x1p-80 \* axis.scale)/0.0f/'
    mutant families detail/base/rounding.hpp 's/return static_cast<double>(nearest) > value ? next_below(nearest) : nearest;/return nearest;/'
    mutant families detail/engine/cell_boxes.hpp 's/from -= abs_of(from) \* 0x1p-21 + 0x1p-100;/from += abs_of(from) * 0x1p-21;/'
    mutant families detail/engine/cell_boxes.hpp 's/(1 + 0x1p-20f)) + 0x1p-125f/(1 - 0x1p-20f))/'
    mutant world detail/project/world_to_view.hpp 's/\* stretch_ + error) \* (1 + 0x1p-23) +/* stretch_) +/'
    mutant world detail/project/world_to_view.hpp 's/float_above(stretch_ \* (1 + 0x1p-22))/static_cast<float>(stretch_ * (1 - 0x1p-18))/'
    mutant world detail/project/world_to_view.inl 's/(mul(distance, transform.error_rate) + transform.error_at_origin)/transform.error_at_origin/'
    mutant world detail/project/world_to_view.inl 's/less_equal(distance, transform.max_distance)/less_equal(distance, broadcast(0x1p40f))/'
    mutant world detail/project/spheres.inl 's/source.out_spheres != nullptr || fallback != 0/source.out_spheres != nullptr/'
    # Spots.
    mutant spots detail/project/sphere_around.hpp 's/rounded(radius \* (1 + 0x1p-48))/rounded(radius * (1 - 0x1p-20))/'
    mutant spots spot.hpp 's/2 \* cosine2 >= 1;/2 * cosine2 >= 1.1;/'
    mutant spots detail/project/spot_vectors.inl 's/select(less_equal(spots.cosine, along), broadcast(1.0f), rim)/rim/'
    mutant spots detail/project/spots.inl 's/minimum(mul(b - root, rim.per_a), apex), largest/mul(b - root, rim.per_a), largest/'
    mutant spots detail/project/spots.inl 's/mul(squares - rim.rho2, mul(other, other))/mul(squares - rim.rho2, mul(axis, axis))/'
    mutant spots detail/project/spots.inl 's/high = select(touches_cap.*/high = minimum(largest + error, high);/'
    mutant spots detail/project/spots.inl 's/const Floats error = mul(rim.error,/const Floats error = mul(-rim.error,/'
    mutant spots detail/project/spot_vectors.inl 's/? aside : -aside) - back\[i\]/? aside : -aside) + back[i]/'
    mutant spots detail/project/spot_vectors.inl 's/store_tiles(corners, select(less(n\[i\], Floats{})/store_tiles(corners, select(less(Floats{}, n[i])/'
    mutant spots detail/project/spot_vectors.inl 's/const auto with_cone = and_not(safe, less_equal(cosine, broadcast(0.0f)))/const auto with_cone = less(broadcast(0.0f), cosine)/'
    mutant spots detail/project/spots.inl 's/select(narrow, half, mul(spots.radius, spots.sine)) +/select(narrow, half, mul(spots.radius, spots.sine)) * broadcast(0.98f) +/'
    mutant spots detail/project/spot_vectors.inl 's/(centre_error + mul(spots.radius, transform.cone_error))/centre_error/'
    mutant spots detail/project/spot_rows.inl 's/radius \* 0x1p-19 \/ widened(cosine, half)/broadcast(0.0)/'
    mutant spots detail/project/spot_rows.inl 's/: -aside\[i\]) - back\[i\];/: -aside[i]) + back[i];/'
    mutant spots detail/engine/slab.inl 's/select(less(normal, broadcast(0.0f)), broadcast(high), broadcast(low))/select(less(normal, broadcast(0.0f)), broadcast(low), broadcast(high))/'
    mutant spots detail/engine/depth_tests.inl 's/spot.corners\[i\]\[1\]), broadcast(plane.y))/spot.corners[i][1]), broadcast(plane.x))/'
    mutant spots detail/project/world_to_view.hpp 's/smallest2 = min_of(smallest2, 2 \* diagonal - row_sum);/smallest2 = max_of(largest2, row_sum);/'
    mutant least_spheres spot.hpp 's/axis_length;/(axis_length * (1 + 0x1p-18));/'
    # Projection.
    mutant families detail/project/spheres.inl 's/either(either(less(farthest, view.front)/either(either(less(nearest, view.front)/'
    mutant families detail/project/spheres.inl 's/less(size \* 0x1p-21f, outside - r)/less(size * -0x1p-19f, outside - r)/'
    mutant families detail/project/spheres.inl 's/+ offset - margin;/+ offset + margin;/'
    mutant families detail/project/spheres.inl 's/less_equal(size, broadcast(float_safe_max))/less_equal(size, broadcast(0x1p100f))/'
    mutant families detail/project/spheres.inl 's/const auto behind = less(z, zero);/const auto behind = less(zero, z);/'
    mutant cells detail/project/spheres.inl 's/const auto whole = less(broadcast(near_depth), nearest);/const auto whole = less(broadcast(0.0), nearest);/'
    mutant families detail/project/spheres.inl 's/const Doubles h = sqrt(maximum(h2, zero) + h2_error);/const Doubles h = sqrt(maximum(h2, zero)) * 0.999;/'
    # Silhouettes.
    mutant families detail/project/sphere_rows.inl 's/+ mul(reach, right_s) + terms.high/+ mul(reach, right_s) * broadcast(0.999) + terms.high/'
    mutant families detail/project/sphere_rows.inl 's/right_v = select(negative, inner_v, outer_v);/right_v = select(negative, outer_v, inner_v);/'
    # Depth.
    mutant families detail/depth/depth_columns.inl 's/store_floats(upper + column, select(numbers, greatest, infinite));/store_floats(upper + column, greatest);/'
    mutant families detail/engine/cells.inl 's/select(less(edges, broadcast(0.0f)), back, front)/select(less(broadcast(0.0f), edges), back, front)/'
    mutant families detail/engine/cells.inl 's/select(both(gap, less(z0, gap_max)), gap_max, z0)/select(both(gap, less(z0, gap_max)), gap_max, z1)/'
    mutant families detail/engine/depth_tests.inl 's/either(less(farthest, load_floats(cell)), less(load_floats(cell + 64), nearest))/either(less(nearest, load_floats(cell)), less(load_floats(cell + 64), nearest))/'
    mutant families detail/engine/cells.inl 's/maximum(min, broadcast(-infinity))/min/'
    # Lists.
    mutant families detail/engine/lists_insert.inl 's/(rows.last \/ 8 + 1) \* pitch/(rows.last \/ 8) * pitch/'
    mutant families detail/engine/lists_insert.inl 's/to.put(list\[1\], id, column_bits >> 8, row_bits);/to.put(list[1], id, column_bits >> 7, row_bits);/'
    mutant families detail/engine/lists.inl 's/coordinates(lights.y1 + i, 1, to.begin)/coordinates(lights.y1 + i, 0, to.begin)/'
    mutant families detail/engine/lists.inl 's/unsigned begin = 8 \* panel_side \* panel;/unsigned begin = 8 * panel_side * panel + 8;/'
    mutant families detail/engine/lists.inl 's/const ByteMask chosen = not_zero(here) & first_bytes(end - at);/const ByteMask chosen = not_zero(here);/'
    # Words and entries.
    mutant families detail/engine/depth_tests.inl 's/span.first < 8 \* x + 8 \&\& span.last >= 8 \* x;/span.first < 8 * x + 8 \&\& span.last > 8 * x;/'
    mutant families detail/engine/emit.inl 's/if (count <= 16) return out;/if (count <= 17) return out;/'
    mutant families detail/engine/emit_compress.inl 's/if (count > 32) store_32/if (count > 33) store_32/'
    mutant families detail/engine/emit_compress.inl 's/else if (count < 32)/else if (count <= 32)/'
    # Scattering, and the caller's threads.
    mutant families detail/engine/scatter.inl 's/lights.x1\[i\] - lights.x0\[i\] + 1u;/lights.x1[i] - lights.x0[i];/'
    mutant families detail/engine/scatter.inl 's/min_of(lights.y1\[i\] + 1u, end)/min_of(lights.y1[i] + 0u, end)/'
    mutant families detail/engine/shares.hpp 's/            ++step;$/            step += done < goal ? 1 : 2;/'
    # Clusters.
    mutant clusters detail/depth/slice_table.hpp 's/return boundary <= farthest;/return boundary < farthest;/'
    mutant clusters detail/depth/slice_table.hpp 's/return boundary < nearest;/return boundary <= nearest;/'
    mutant clusters detail/depth/slice_indices.inl 's/broadcast(buckets.begin), broadcast(buckets.scale))/broadcast(buckets.begin), broadcast(buckets.scale)) + broadcast(1.0f)/'
    mutant clusters detail/engine/slab.inl 's/broadcast(1 + 0x1p-20f)) + broadcast(0x1p-125f)/broadcast(1 - 0x1p-20f))/'
    mutant clusters detail/engine/slab.inl 's/slab.z0, slab.z1)}/slab.z0, slab.z0)}/'
    mutant clusters detail/depth/sliced_footprints.hpp 's/slice = met->first + 2; slice <= met->last/slice = met->first + 2; slice < met->last/'
}

# The proof of mutant $number, which is expected to fail. Says what came of it; a line that does not start with "caught" is
# a hole in the proof, or a mutant that is out of date.
try() {
    proof=$1 file=$2 expression=$3
    place=$work/$number
    rm -rf "$place"
    mkdir -p "$place"
    cp -r include "$place/include"
    sed -i "$expression" "$place/include/lightbin/$file"
    if cmp -s "include/lightbin/$file" "$place/include/lightbin/$file"; then
        echo "OUT OF DATE, it changes nothing: $number $file $expression"
        return
    fi
    flags="-std=c++20 -O1 -w -I$place/include"
    # shellcheck disable=SC2086  # several flags
    case $proof in
    families)
        g++ $flags -c tests/oracle/engine.cpp -o "$place/engine.o" 2>"$place/log" &&
            g++ "$place/engine.o" $work/judge.o $work/campaign.o -lgmp -o "$place/proof"
        arguments=2000
        ;;
    *)
        g++ $flags tests/oracle/$proof.cpp $work/doctest_main.o -lgmp -o "$place/proof" 2>"$place/log"
        arguments='--test-case=cells: symmetric,world space*,clusters: symmetric,spots: symmetric,spots: world space,spots: missed once,the least*'
        ;;
    esac || {
        echo "DOES NOT COMPILE: $number $file $expression"
        return
    }
    if "$place/proof" "$arguments" >"$place/log" 2>&1; then
        echo "SURVIVES $proof: $number $file $expression"
    else
        echo "caught by $proof: $number $file $expression"
    fi
    rm -rf "$place/include" "$place/proof" "$place/engine.o"
}

if [ "${1-}" = --one ]; then
    wanted=$2 number=0
    mutant() {
        number=$((number + 1))
        [ $number -ne "$wanted" ] || try "$@"
    }
    list
    exit
fi

install_packages g++ libboost-dev libgmp-dev doctest-dev libglm-dev
make_build_folder
mkdir -p $work
for part in judge campaign; do
    g++ -std=c++20 -O1 -Iinclude -c tests/oracle/$part.cpp -o $work/$part.o
done
g++ -std=c++20 -O1 -c tests/doctest_main.cpp -o $work/doctest_main.o
count=0
mutant() { count=$((count + 1)); }
list
numbers=${*:-$(seq "$count")}
echo "$me: $(echo "$numbers" | wc -w) of $count mutants"
# shellcheck disable=SC2086  # several numbers
printf '%s\n' $numbers | xargs -P "$(nproc)" -n 1 sh $me --one | tee $work/report
! grep -v '^caught' $work/report >/dev/null || fail "not every mutant is caught"
echo "$me: every mutant is caught"
