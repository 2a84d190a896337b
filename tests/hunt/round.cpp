// SPDX-License-Identifier: MIT
#include "round.hpp"

#include "bounds.hpp"
#include "engines.hpp"
#include "guarded.hpp"
#include "slices.hpp"

#include <lightbin/advise.hpp>
#include <lightbin/encode.hpp>
#include <lightbin/shader_build.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace hunt {
namespace {

constexpr Footprint footprints[] = {Footprint::rectangle, Footprint::silhouette};
constexpr DepthTest depth_tests[] = {DepthTest::none, DepthTest::interval, DepthTest::box,
                                     DepthTest::split_box};
constexpr std::size_t most_entries = 20'000'000;

class Round {
public:
    Round(std::uint64_t seed, std::uint64_t round, Report& report)
        : seed_(seed), round_(round), random_(seed ^ round * 0xd1342543de82ef95), report_(report) {}

    void run() {
        // Each kind comes up once in as many rounds as there are kinds.
        const auto deal = [&](int salt, auto& kinds) {
            const int kind = dealt(seed_ * 31 + static_cast<std::uint64_t>(salt), round_,
                                   static_cast<int>(std::size(kinds)));
            return kind;
        };
        const int camera_kind = deal(1, camera_kinds), grid_kind = deal(2, grid_kinds),
                  space = deal(3, space_kinds), bounds_kind = deal(4, bounds_kinds);
        const std::uint32_t lights = light_counts[deal(5, light_counts)];
        what_ = std::string(camera_kinds[camera_kind]) + ", " + grid_kinds[grid_kind] + ", " +
                space_kinds[space] + ", bounds " + bounds_kinds[bounds_kind] + ", " + std::to_string(lights) +
                " lights";

        std::optional<lightbin::View> view;
        for (int tries = 0; tries < 20 && !view; ++tries) {
            camera_ = make_camera(camera_kind, random_);
            set_grid(camera_, grid_kind, random_);
            const auto made = make_view();
            if (made)
                view = *made;
            else if (ordinary(camera_kind))
                fault("an ordinary camera is refused: " + made.error().message());
            else
                ++report_.tally["camera refused"];
        }
        if (!view) return;
        view_ = &*view;
        count_camera(camera_kind, grid_kind);
        ++report_.tally[space_kinds[space]];
        ++report_.tally[bounds_kinds[bounds_kind]];
        ++report_.tally[std::to_string(lights) + " lights"];

        const std::size_t tiles = view->tile_count();
        constexpr std::uint64_t most = 250'000;
        const std::uint32_t large = static_cast<std::uint32_t>(
            std::uint64_t{lights} * tiles <= most ? lights
                                                  : std::min<std::uint64_t>(lights, most / (2 * tiles) + 1));
        scene_ = make_scene(camera_, space, lights, large, random_, report_.tally);
        keep_small(large);
        rejected_ = static_cast<std::uint32_t>(std::ranges::count_if(scene_.lights, is_bad));
        place_points();
        const std::string wrong =
            make_bounds(bounds_kind, camera_, *view_, placed_, random_, report_.tally, bounds_);
        if (!wrong.empty()) fault(wrong);
        for (int more = 0; more < 3; ++more) {  // small ones cost next to nothing
            if (camera_.viewport.width * camera_.viewport.height > 50'000) break;
            Bounds unused;
            const std::string fault_found =
                make_bounds(static_cast<int>(std::size(bounds_kinds)) - 1, camera_, *view_, placed_, random_,
                            report_.tally, unused);
            if (!fault_found.empty()) fault(fault_found);
        }
        if (random_.one_in(2) && tiles > 0) {
            // The same grid by way of another.
            const auto other = view->with_tile_size(random_.from_to(1, 64));
            const auto back = other ? other->with_tile_size(view->tile_size()) : other;
            if (!back) return fault("with_tile_size refuses");
            view = *back;
            ++report_.tally["with_tile_size"];
        }
        hunt_grids();
        for (int more = 0; more < 2; ++more)
            if (const std::string found = hunt_slices(*view_, scene_, placed_, random_, report_);
                !found.empty())
                fault(found);
        if (lights <= 5000 && tiles <= 20000 && random_.one_in(4)) ask_advice();
    }

private:
    lightbin::Result<lightbin::View> make_view() const {
        if (camera_.in_float)
            return lightbin::View::from_projection(glm::mat4(camera_.matrix), camera_.viewport,
                                                   camera_.options);
        return lightbin::View::from_projection(camera_.matrix, camera_.viewport, camera_.options);
    }

    /// Where lights that should be small cover much all the same, shrinks them or in the end leaves them out, as the
    /// round would take minutes and gigabytes.
    void keep_small(std::uint32_t large) {
        for (int tries = 0; large < scene_.lights.size(); ++tries) {
            const auto rectangles = scene_.in_world
                                        ? lightbin::shader_footprints(
                                              *view_, lightbin::world_space(scene_.lights, scene_.to_view))
                                        : lightbin::shader_footprints(*view_, scene_.lights);
            double entries = 0;
            for (const lightbin::ShaderFootprint& f : *rectangles)
                entries += (f.x1 - f.x0 + 1.0) * (f.y1 - f.y0 + 1.0);
            if (entries < 2e6) return;
            ++report_.tally["lights shrunk"];
            if (tries < 4) {
                for (Sphere& light : scene_.lights)
                    if (random_.coin() && light.radius > 0) light.radius *= 0.01f;
            } else {
                scene_.lights.resize(std::max<std::size_t>(large, scene_.lights.size() / 8));
                std::erase_if(scene_.inside,
                              [&](const Inside& i) { return i.light >= scene_.lights.size(); });
            }
        }
    }

    void fault(const std::string& what) {
        if (++faults_ > 3) return;  // the rest says no more
        report_.faults.push_back(what + "\n    in seed " + std::to_string(seed_) + ", round " +
                                 std::to_string(round_) + ": " + what_);
    }

    void count_camera(int camera_kind, int grid_kind) {
        Tally& tally = report_.tally;
        ++tally[camera_kinds[camera_kind]];
        ++tally[grid_kinds[grid_kind]];
        ++tally[camera_.in_float ? "float projection" : "double projection"];
        ++tally[camera_.toward > 0 ? "looks down +z" : "looks down -z"];
        ++tally[camera_.options.clip_depth == lightbin::ClipDepth::zero_to_one ? "depth 0 to 1"
                                                                               : "depth -1 to 1"];
        ++tally[camera_.options.origin == lightbin::WindowOrigin::lower_left ? "lower left" : "upper left"];
        if (view_->reversed_z())
            ++tally[view_->orthographic() ? "reversed orthographic" : "reversed perspective"];
        if (camera_.matrix[0][0] < 0) ++tally["x flipped"];
        if (camera_.matrix[1][1] < 0) ++tally["y flipped"];
        const int size = view_->tile_size();
        if (view_->tile_count() > 0 && view_->tiles_x() != (camera_.viewport.width - 1) / size + 1)
            fault("tiles_x is not what the viewport needs");
        if (view_->tile_count() > 0 && view_->tiles_y() != (camera_.viewport.height - 1) / size + 1)
            fault("tiles_y is not what the viewport needs");
    }

    /// Keeps the points that are surely in their light, surely in view and surely in one tile.
    void place_points() {
        std::vector<Inside> points = scene_.inside;
        find_points(camera_, scene_, random_, points);
        placed_.clear();
        if (view_->tile_count() == 0) return;
        for (const Inside& point : points) {
            ++report_.tally["points tried"];
            if (!surely_inside(scene_.lights[point.light], point.point)) continue;
            const auto seen = see(camera_, in_view_space(scene_, point.point));
            if (!seen) continue;
            const int size = view_->tile_size();
            const auto tile = [&](long double at) { return std::floor(at / size); };
            const auto side_tile = [&](Real at, int side) {  // -1 where not known
                const long double low = std::floor(at.low()), high = std::floor(at.high());
                return low >= 0 && high < side && tile(low) == tile(high) ? static_cast<int>(tile(low)) : -1;
            };
            const int x = side_tile(seen->x, camera_.viewport.width),
                      y = side_tile(seen->y, camera_.viewport.height);
            if (x < 0 || y < 0) continue;
            Placed placed = {point, *seen,
                             static_cast<std::size_t>(y) * static_cast<std::size_t>(view_->tiles_x()) +
                                 static_cast<std::size_t>(x),
                             static_cast<int>(std::floor(seen->x.value)),
                             static_cast<int>(std::floor(seen->y.value))};
            if (std::floor(seen->x.low()) != std::floor(seen->x.high()) ||
                std::floor(seen->y.low()) != std::floor(seen->y.high()))
                placed.pixel_x = -1;
            if (surely_less(seen->depth, static_cast<long double>(view_->near_depth())) ||
                surely_less(static_cast<long double>(view_->far_depth()), seen->depth))
                fault("MISS: a point in view is not between View's near and far depth");
            placed_.push_back(placed);
            ++report_.tally["points placed"];
        }
    }

    /// Looks for the lights of all points that lie within the bounds.
    void look_for_points(const Lists& lists, const Bounds& bounds, DepthTest depth_test,
                         const std::string& how) {
        for (const Placed& point : placed_) {
            if (depth_test != DepthTest::none &&
                !surely_within(bounds, depth_test == DepthTest::split_box, point.tile, point.seen.depth))
                continue;
            ++report_.points;
            ++report_.tally[std::string("points, ") + to_string(depth_test)];
            const auto list = lists.of(point.tile);
            if (std::ranges::binary_search(list, point.inside.light)) continue;
            const Sphere& light = scene_.lights[point.inside.light];
            const Point& p = point.inside.point;
            char line[500];
            std::snprintf(
                line, sizeof line,
                "MISS: light %u (%.9g, %.9g, %.9g, %.9g) holds (%.21Lg, %.21Lg, %.21Lg), seen at pixel "
                "%.12Lg, "
                "%.12Lg in tile %zu of %d x %d at depth %.12Lg, but the tile's list of %zu lacks it; %s",
                point.inside.light, light.x, light.y, light.z, light.radius, p[0], p[1], p[2],
                point.seen.x.value, point.seen.y.value, point.tile, view_->tiles_x(), view_->tiles_y(),
                point.seen.depth.value, list.size(), how.c_str());
            return fault(line);
        }
    }

    /// What the public words say of any grid.
    void check_grid(const Output& out, const std::string& how) {
        if (!out.wrong.empty()) fault(out.wrong + "; " + how);
        if (out.tiles_x != view_->tiles_x() || out.tiles_y != view_->tiles_y())
            fault("the grid has other sides; " + how);
        check_lists(out.lists, how);
        std::uint32_t longest = 0;
        std::array<std::uint64_t, 33> histogram = {};
        for (const lightbin::ListRange range : out.lists.tiles) {
            longest = std::max(longest, range.count);
            ++histogram[static_cast<std::size_t>(std::bit_width(range.count))];
        }
        if (out.lengths.longest != longest || out.lengths.histogram != histogram)
            fault("the lengths are not those of the lists; " + how);
        std::vector<bool> listed(scene_.lights.size());
        for (const std::uint32_t id : out.lists.ids)
            if (id < listed.size()) listed[id] = true;
        const std::uint64_t seen = static_cast<std::uint64_t>(std::ranges::count(listed, true));
        const lightbin::LightCounts& counts = out.counts;
        if (counts.lights != scene_.lights.size() || counts.rejected != rejected_ ||
            counts.lights < counts.rejected + counts.culled + seen)
            fault("the counts are not those of the lights: " + std::to_string(counts.rejected) + " of " +
                  std::to_string(rejected_) + " are rejected; " + how);
    }

    void check_lists(const Lists& lists, const std::string& how) {
        if (lists.tiles.size() != view_->tile_count())
            return fault("tiles has another length than the view; " + how);
        std::uint64_t at = 0;
        for (const lightbin::ListRange range : lists.tiles) {
            if (range.offset != at) return fault("offsets leave a gap or overlap; " + how);
            at += range.count;
        }
        if (at != lists.ids.size()) return fault("counts do not add up to the index list; " + how);
        for (const lightbin::ListRange range : lists.tiles)
            for (std::uint32_t i = 0; i < range.count; ++i) {
                const std::uint32_t id = lists.ids[range.offset + i];
                if (id >= scene_.lights.size()) return fault("an id that no light has; " + how);
                if (i > 0 && lists.ids[range.offset + i - 1] >= id) return fault("ids do not ascend; " + how);
            }
    }

    static bool same(const Lists& a, const Lists& b) {
        return a.tiles.size() == b.tiles.size() && a.ids == b.ids &&
               (a.tiles.empty() || std::memcmp(a.tiles.data(), b.tiles.data(),
                                               a.tiles.size() * sizeof(lightbin::ListRange)) == 0);
    }

    void check_within(const Lists& smaller, const Lists& larger, const char* what) {
        if (smaller.tiles.size() != larger.tiles.size()) return;
        for (std::size_t tile = 0; tile < smaller.tiles.size(); ++tile)
            if (!at_no_depth(tile) && !std::ranges::includes(larger.of(tile), smaller.of(tile)))
                return fault(std::string(what) + ": a tile lists more lights with it than without");
    }

    /// Whether a bound is infinite the wrong way: nothing is there, and a test may have it either way.
    bool at_no_depth(std::size_t tile) const {
        const auto& [min, max, gap_min, gap_max] = bounds_.sides;
        constexpr float infinite = std::numeric_limits<float>::infinity();
        return (!min.empty() && min[tile] == infinite) || (!max.empty() && max[tile] == -infinite);
    }

    /// Every footprint and depth test: one grid that is looked into, and others, of other tiers, ids, threads and
    /// calls, that must be the same.
    void hunt_grids() {
        Output grids[2][4];
        const bool costly = view_->tile_count() > 20'000 || scene_.lights.size() > 2000;
        bool too_large = false;
        for (int f = 0; f < 2; ++f)
            for (int d = 0; d < 4 && !too_large; ++d) {
                if (costly && !random_.one_in(3)) continue;
                const unsigned first_tier =
                    static_cast<unsigned>(random_.below(static_cast<int>(tier_count)));
                Output& grid = grids[f][d];
                grid = build(footprints[f], depth_tests[d], first_tier, true, nullptr);
                if (grid.error) {
                    ++report_.tally["too many entries"];
                    too_large = true;
                    break;
                }
                too_large = grid.lists.ids.size() > most_entries;
                std::string how = std::string(to_string(footprints[f])) + ", " + to_string(depth_tests[d]) +
                                  ", " + tier_names[first_tier];
                look_for_points(grid.lists, bounds_, depth_tests[d], how);
                if (d > 0) check_empty_tiles(grid.lists, how);
                Bounds only_max;
                only_max.sides[1] = bounds_.sides[1];
                Output transparent;
                if (d > 0) {
                    const Bounds kept = bounds_;
                    bounds_ = only_max;
                    transparent = build(footprints[f], depth_tests[d], first_tier, true, nullptr);
                    look_for_points(transparent.lists, bounds_, depth_tests[d], how + ", transparent");
                    bounds_ = kept;
                }
                for (unsigned tier = 0; tier < tier_count; ++tier)
                    if (costly ? random_.one_in(3) : tier != first_tier || random_.coin())
                        build(footprints[f], depth_tests[d], tier, false, &grid, &transparent);
            }
        const auto have = [&](const Output& a) { return !a.lists.tiles.empty() && !a.error; };
        for (int f = 0; f < 2; ++f)
            for (int d = 1; d < 4; ++d) {
                static constexpr int looser[] = {0, 0, 1, 2};
                if (have(grids[f][d]) && have(grids[f][looser[d]]))
                    check_within(grids[f][d].lists, grids[f][looser[d]].lists, to_string(depth_tests[d]));
            }
        for (int d = 0; d < 4; ++d)
            if (have(grids[0][d]) && have(grids[1][d]))
                check_within(grids[1][d].lists, grids[0][d].lists, "silhouette");
        for (int d = 0; d < 4; ++d)
            if (have(grids[0][d]) && random_.one_in(3)) check_encodings(grids[0][d].lists);
        if (too_large || view_->tile_count() > 1'000'000)  // the Binners would keep much memory
            for (int f = 0; f < 2; ++f)
                for (int d = 0; d < 4; ++d)
                    for (unsigned tier = 0; tier < tier_count; ++tier)
                        for (const IdWidth ids : {IdWidth::u16, IdWidth::u32})
                            engine_of(depth_tests[d], footprints[f], tier, ids).forget();
    }

    /// Builds a grid in a way of its own, `plainly` with 32-bit ids on the calling thread, and compares it.
    Output build(Footprint footprint, DepthTest depth_test, unsigned tier, bool plainly,
                 const Output* expected, const Output* transparent = nullptr) {
        const bool narrow =
            !plainly && scene_.lights.size() <= 65536 && has_narrow_ids(depth_test) && random_.coin();
        const Engine engine = engine_of(depth_test, footprint, tier, narrow ? IdWidth::u16 : IdWidth::u32);
        Input input = {view_, &scene_, bounds_.spans()};
        input.seed = random_.bits();
        input.form = static_cast<Form>(random_.below(3));
        if (!plainly) {
            input.calls = static_cast<Calls>(random_.below(depth_test == DepthTest::none ? 2 : 3));
            input.order = static_cast<Order>(random_.one_in(6) ? 4 : random_.below(4));
            input.workers = static_cast<unsigned>(random_.pick({1, 2, 3, 4, 7, 8, 16, 33, 64}));
        }
        if (random_.one_in(8)) engine.forget();
        Tally& tally = report_.tally;
        const IdWidth ids = narrow ? IdWidth::u16 : IdWidth::u32;
        const std::string engine_name =
            std::string(to_string(footprint)) + ", " + to_string(depth_test) + ", " + tier_names[tier];
        const std::string how =
            engine_name + ", " + to_string(ids) + ", " + form_names[static_cast<int>(input.form)] + ", " +
            call_names[static_cast<int>(input.calls)] + ", " + order_names[static_cast<int>(input.order)] +
            " of " + std::to_string(input.workers);
        ++tally[engine_name];
        ++tally[to_string(ids)];
        ++tally[form_names[static_cast<int>(input.form)]];
        ++tally[call_names[static_cast<int>(input.calls)]];
        ++tally[order_names[static_cast<int>(input.order)]];
        Output out = engine.run(input);
        ++report_.grids;
        if (out.error) {
            using lightbin::ErrorCode;
            if (out.error->code != ErrorCode::too_many_entries &&
                out.error->code != ErrorCode::too_many_list_places)
                fault("refused: " + out.error->message() + "; " + how);
            if (expected != nullptr) fault("refused in one way alone: " + out.error->message() + "; " + how);
            return out;
        }
        report_.entries += out.lists.ids.size();
        check_grid(out, how);
        if (expected != nullptr && !same(out.lists, expected->lists)) fault("another grid; " + how);
        if (expected != nullptr && input.calls == Calls::transparency &&
            !same(out.transparent, transparent->lists))
            fault("another grid of the transparent; " + how);
        return out;
    }

    /// Tiles where nothing is drawn have no lights.
    void check_empty_tiles(const Lists& lists, const std::string& how) {
        const auto& [min, max, gap_min, gap_max] = bounds_.sides;
        if (min.empty() || max.empty()) return;
        for (std::size_t tile = 0; tile < lists.tiles.size(); ++tile)
            if (min[tile] > max[tile] && lists.tiles[tile].count > 0)
                return fault("a tile where nothing is drawn has lights; " + how);
    }

    void check_encodings(const Lists& lists) {
        using namespace lightbin;
        const LightGrid<std::uint32_t> grid(view_->tiles_x(), view_->tiles_y(), lists.tiles, lists.ids);
        const std::uint32_t lights = static_cast<std::uint32_t>(scene_.lights.size());
        std::uint32_t longest = 0, highest = 0;
        for (const ListRange range : lists.tiles)
            longest = std::max(longest, range.count);
        for (const std::uint32_t id : lists.ids)
            highest = std::max(highest, id);
        ListFormat format;
        const int encoding = random_.below(3);
        format.encoding = static_cast<ListEncoding>(encoding);
        format.ids = random_.pick({IdWidth::u8, IdWidth::u16, IdWidth::u32});
        const std::size_t width = static_cast<std::size_t>(format.ids);
        format.capacity = longest == 0 ? 1
                          : random_.coin()
                              ? longest
                              : static_cast<std::uint32_t>(random_.from_to(1, static_cast<int>(longest) + 2));
        format.max_lights = format.encoding == ListEncoding::bitmask || random_.coin()
                                ? lights + static_cast<std::uint32_t>(random_.below(70))
                                : 0;
        if (format.encoding == ListEncoding::bitmask && format.max_lights == 0) return;
        const std::uint64_t bytes = encoded_bytes(format, lists.tiles.size(), lists.ids.size());
        if (bytes > 50'000'000) return;
        ++report_.tally[to_string(format.encoding)];
        Guarded<std::byte> out(static_cast<std::size_t>(bytes) + random_.below(std::size_t{9}));
        const std::uint64_t numbers =
            (std::uint64_t{1} << 8 * width) - (format.encoding == ListEncoding::sentinel ? 1 : 0);
        const bool countable = format.encoding == ListEncoding::bitmask ||
                               ((lists.ids.empty() || highest < numbers) && format.max_lights <= numbers);
        if (bytes > 0 && countable) {
            const auto few = encode(grid, format, out.span(static_cast<std::size_t>(bytes) - 1));
            if (few || !out.intact(0))
                return fault(std::string("encode takes a buffer that is too small, ") +
                             to_string(format.encoding));
        }
        const auto encoded = encode(grid, format, out.span());
        if (!countable) {
            ++report_.tally["ids too narrow"];
            if (encoded || encoded.error().code != ErrorCode::ids_too_narrow || !out.intact(0))
                fault(std::string("encode writes ids that the format can't number, ") +
                      to_string(format.encoding));
            return;
        }
        if (!encoded) return fault("encode refuses: " + encoded.error().message());
        const std::size_t written = format.encoding == ListEncoding::offset_count
                                        ? lists.ids.size() * width
                                        : static_cast<std::size_t>(bytes);
        if (!out.intact(written))
            return fault(std::string("encode writes beyond its bytes, ") + to_string(format.encoding));
        const std::byte* const from = out.span().data();
        const auto id_at = [&](std::size_t i) {
            std::uint32_t id = 0;
            for (std::size_t byte = 0; byte < width; ++byte) {
                const std::size_t shift =
                    std::endian::native == std::endian::little ? byte : width - 1 - byte;
                id |= static_cast<std::uint32_t>(from[i * width + byte]) << 8 * shift;
            }
            return id;
        };
        std::uint64_t cut = 0;
        std::uint32_t tiles_cut = 0;
        std::vector<std::uint32_t> decoded;
        for (std::size_t tile = 0; tile < lists.tiles.size(); ++tile) {
            const auto list = lists.of(tile);
            auto expected = list;
            decoded.clear();
            if (format.encoding == ListEncoding::offset_count) {
                for (std::size_t i = 0; i < list.size(); ++i)
                    decoded.push_back(id_at(lists.tiles[tile].offset + i));
            } else if (format.encoding == ListEncoding::sentinel) {
                const std::uint32_t sentinel = width == 4 ? 0xffffffff : (1u << 8 * width) - 1;
                for (std::size_t i = 0; i < format.capacity; ++i) {
                    const std::uint32_t id = id_at(tile * format.capacity + i);
                    if (id == sentinel) break;
                    decoded.push_back(id);
                }
                expected = list.first(std::min<std::size_t>(list.size(), format.capacity));
                cut += list.size() - expected.size();
                tiles_cut += list.size() > expected.size();
            } else {
                const std::size_t words = (format.max_lights + 31) / 32;
                for (std::uint32_t id = 0; id < words * 32; ++id) {
                    std::uint32_t word;
                    std::memcpy(&word, from + (tile * words + id / 32) * 4, 4);
                    if ((word >> id % 32 & 1) != 0) decoded.push_back(id);
                }
            }
            if (!std::ranges::equal(decoded, expected))
                return fault(std::string("encode: a tile's list is another one, ") +
                             to_string(format.encoding));
        }
        if (encoded->entries_cut != cut || encoded->tiles_cut != tiles_cut ||
            encoded->capacity_needed != longest)
            fault("encode counts other losses");
    }

    void ask_advice() {
        ++report_.tally["advise"];
        const auto check = [&](const auto& advice) {
            if (!advice) return fault("advise refuses: " + advice.error().message());
            double before = 0;
            for (const lightbin::Plan& plan : advice->plans()) {
                if (!(plan.build_ns >= 0) || !(plan.evaluations >= 0) || !std::isfinite(plan.total_ns) ||
                    plan.total_ns < before)
                    fault("advise: a plan without a sound price");
                before = plan.total_ns;
            }
        };
        const lightbin::ZBounds bounds = random_.coin() ? bounds_.spans() : lightbin::ZBounds{};
        if (scene_.in_world)
            check(lightbin::advise(*view_, lightbin::world_space(scene_.lights, scene_.to_view), {}, bounds));
        else
            check(lightbin::advise(*view_, scene_.lights, {}, bounds));
    }

    std::uint64_t seed_, round_;
    int faults_ = 0;
    Random random_;
    Report& report_;
    std::string what_;
    Camera camera_;
    const lightbin::View* view_ = nullptr;
    Scene scene_;
    std::uint32_t rejected_ = 0;
    std::vector<Placed> placed_;
    Bounds bounds_;
};

}  // namespace

void hunt_round(std::uint64_t seed, std::uint64_t round, Report& report) {
    Round(seed, round, report).run();
    ++report.tally["rounds"];
}

void expect_all(Tally& tally) {
    const auto expect = [&](const auto& names) {
        for (const auto& name : names)
            tally[name];
    };
    expect(camera_kinds);
    expect(grid_kinds);
    expect(space_kinds);
    expect(light_kinds);
    expect(bounds_kinds);
    expect(form_names);
    expect(call_names);
    expect(order_names);
    for (const std::uint32_t count : light_counts)
        tally[std::to_string(count) + " lights"];
    for (const Footprint footprint : footprints)
        for (const DepthTest depth_test : depth_tests)
            for (const char* tier : tier_names)
                tally[std::string(to_string(footprint)) + ", " + to_string(depth_test) + ", " + tier];
    for (const char* name : slicing_names)
        tally[name];
    for (const DepthTest depth_test : depth_tests)
        tally[std::string("points, ") + to_string(depth_test)];
    for (const char* name : {"float projection",
                             "double projection",
                             "looks down +z",
                             "looks down -z",
                             "depth 0 to 1",
                             "depth -1 to 1",
                             "lower left",
                             "upper left",
                             "reversed orthographic",
                             "reversed perspective",
                             "x flipped",
                             "y flipped",
                             "with_tile_size",
                             "float32",
                             "unorm24",
                             "unorm16",
                             "u16",
                             "u32",
                             "offset_count",
                             "sentinel",
                             "bitmask",
                             "ids too narrow",
                             "advise",
                             "points drawn",
                             "background skipped",
                             "background counts",
                             "one sample",
                             "many samples",
                             "pitch",
                             "no pitch"})
        tally[name];
}

}  // namespace hunt
