// SPDX-License-Identifier: MIT
// Stability: may change.
// dump(): a frame as text, with all that its lists were made of, for bug reports and tests.
#pragma once

#include <lightbin/binner.hpp>
#include <lightbin/masks.hpp>
#include <lightbin/version.hpp>

#include <cstdio>
#include <cstring>
#include <string>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

namespace detail {

/// Makes JSON text.
class JsonText {
public:
    std::string text;

    /// Adds a number in as many digits as give readers the same bits.
    template <class Number> void add(Number number) {
        if constexpr (std::is_integral_v<Number>) {
            text += std::to_string(number);
        } else if (!is_finite(number)) {
            text += is_nan(number) ? "\"NaN\"" : number < 0 ? "\"-Infinity\"" : "\"Infinity\"";
        } else {
            char digits[40];
            std::snprintf(digits, sizeof digits, "%.*g", std::numeric_limits<Number>::max_digits10,
                          static_cast<double>(number));
            add_digits(digits);
        }
    }
    /// Adds what printf made of a finite number, with a point whatever the locale's is, which may have several bytes.
    void add_digits(const char* digits) {
        for (const char* c = digits; *c != 0; ++c)
            if ((*c >= '0' && *c <= '9') || *c == '-' || *c == '+' || *c == 'e')
                text += *c;
            else if (text.back() != '.')
                text += '.';
        if (std::strcmp(digits, "-0") == 0)
            text += ".0";  // readers take -0 for a whole number, without a sign
    }
    void add(bool value) { text += value ? "true" : "false"; }
    void add(const char* word) { ((text += '"') += word) += '"'; }
    void add(const Matrix& matrix) { add_numbers<double>(&matrix, 1); }
    void add(std::span<const ListRange> ranges) { add_numbers<std::uint32_t>(ranges.data(), ranges.size()); }
    void add(std::span<const BinRange> bins) { add_numbers<std::uint32_t>(bins.data(), bins.size()); }
    template <class Number> void add(std::span<const Number> all) { add_numbers<Number>(all.data(), all.size()); }

    /// Adds an array of the numbers that some objects consist of, 32 in a line.
    template <class Number, class Object> void add_numbers(const Object* objects, std::size_t count) {
        text += '[';
        for (std::size_t i = 0; i < count * sizeof(Object) / sizeof(Number); ++i) {
            Number number;
            std::memcpy(&number, reinterpret_cast<const char*>(objects) + i * sizeof number, sizeof number);
            if (i > 0) text += i % 32 == 0 ? ",\n" : ",";
            add(number);
        }
        text += ']';
    }

    /// Adds a member to an object.
    template <class Value> void member(const char* name, const Value& value) {
        begin(name, "");
        add(value);
    }
    /// Begins a member that is an object or an array.
    void begin(const char* name, const char* bracket) {
        if (text.back() != '{') text += ",\n";
        add(name);
        (text += ": ") += bracket;
    }
};

template <class Array> void dump_array(JsonText& json, const Array& lights) {
    json.text += json.text.back() == '[' ? "{" : ",\n{";
    json.member("kind", name_at(Array::kind, {"spheres", "spots", "boxes"}));
    if (lights.to_view) {
        json.member("view_matrix", lights.to_view->matrix());
        json.member("from_eye", lights.to_view->position_error() > 0);
    }
    json.begin("lights", "[");
    for (std::size_t i = 0; i < lights.array.size(); ++i) {
        typename Array::Made light = {};
        lights.make(i, 1, &light);
        if (i > 0) json.text += ",\n";
        json.add_numbers<float>(&light, 1);
    }
    json.text += "]}";
}

/// What a dump() tells of beside the view, the lights and the lists.
struct DumpedInputs {
    Options options;
    const Slices* slices;
    ZBounds bounds;
};

/// Returns the text of dump(), but for the lists or masks at its end.
template <class Source>
JsonText dump_inputs(const View& view, const Source& lights, const DumpedInputs& given,
                     const LightCounts& counts) {
    const DefaultFloatEnvironment environment;
    const Projection& projection = projection_of(view);
    const Camera& camera = projection.camera;
    const bool by_size = view.tile_size() > 0;
    JsonText json{"{"};
    json.member("version",
                10000 * LIGHTBIN_VERSION_MAJOR + 100 * LIGHTBIN_VERSION_MINOR + LIGHTBIN_VERSION_PATCH);
    json.member("projection", projection.matrix);
    json.member("width", view.viewport().width);
    json.member("height", view.viewport().height);
    json.member("tile_size", view.tile_size());
    json.member("columns", by_size ? 0 : (view.turned() ? camera.y : camera.x).split.tiles);
    json.member("rows", by_size ? 0 : (view.turned() ? camera.x : camera.y).split.tiles);
    json.member("clip_depth", to_string(static_cast<ClipDepth>(projection.depth.zero_to_one)));
    json.member("origin", to_string(view.origin()));
    json.member("reversed_z", view.reversed_z());
    json.member("id_width", to_string(given.options.ids));
    json.member("depth_test", given.options.depth_test);
    json.member("slicing", to_string(given.options.slicing));
    if (given.slices != nullptr) {
        json.member("boundaries", given.slices->boundaries());
        json.member("margin", given.slices->margin());
    }
    json.member("min_depths", given.bounds.min.first(min_of(given.bounds.min.size(), view.tile_count())));
    json.member("max_depths", given.bounds.max.first(min_of(given.bounds.max.size(), view.tile_count())));
    json.begin("arrays", "[");
    for_each_array(lights, [&](const auto& array) {
        if (array.array.size() > 0) dump_array(json, array);
    });
    json.text += ']';
    json.member("lights", counts.lights);
    json.member("rejected", counts.rejected);
    json.member("culled", counts.culled);
    return json;
}

template <class Source, class Id>
std::string dump(const View& view, const Source& lights, const DumpedInputs& given,
                 const LightGrid<Id>& grid) {
    JsonText json = dump_inputs(view, lights, given, grid.light_counts());
    json.member("ranges", grid.ranges());
    json.member("ids", grid.ids());
    json.member("order", grid.ranks().order);
    json.member("bins", grid.ranks().bins);
    return json.text + "}\n";
}
template <class Source>
std::string dump(const View& view, const Source& lights, const Slices* slices, const LightMasks& masks) {
    const Slicing slicing = slices != nullptr ? Slicing::z_bins : Slicing::none;
    JsonText json = dump_inputs(view, lights, {{.slicing = slicing}, slices, {}}, masks.light_counts());
    json.member("words", masks.words());
    return json.text + "}\n";
}

}  // namespace detail

/// Returns a frame as text, to be kept in a file when a picture is wrong: the view, the options, the lights and the
/// lists that a Binner made of them. docs/troubleshooting.md says what can be done with the file.
///
/// binner                for its type alone
/// grid                  what binner.bin() returned. Lights are read once more, so call dump() before they change
/// view, lights, inputs  what binner.bin() was given
///
/// The text is one JSON object. Its members are the version, as lightbin_version() returns it; what from_projection()
/// was given, with the matrix by columns, and max_tiles as columns and rows; the Options; the boundaries and the margin
/// of slices; the Z bounds of each tile; LightCounts; the grid's ranges, ids, order and bins, or the masks' words; and
/// `arrays`, an object for each array of lights that is not empty. Its `lights` have the numbers of each Sphere,
/// Spot or Box in the order of their declaration, as to_light makes them. With world_space() it has the view matrix, by
/// columns. With an eye `from_eye` is true, and centres are relative to the eye, rounded to float.
///
/// Numbers read back to the same bits: those of floats as doubles, rounded to float. NaN and infinity, which JSON has
/// no numbers for, are the strings "NaN", "Infinity" and "-Infinity".
template <Options options, class LightRange>
std::string dump(const Binner<options>&, const LightGrid<typename Binner<options>::Id>& grid, const View& view,
                 const LightRange& lights, const typename Binner<options>::Inputs& inputs = {}) {
    const Slices* slices = nullptr;
    if constexpr (Binner<options>::Inputs::reads_slices) slices = &static_cast<const Slices&>(inputs.slices);
    return detail::dump(view, detail::as_lights(lights), {options, slices, inputs.bounds}, grid);
}

/// Returns as text, in the same form, a frame for which MaskBinner::bin() made masks. If that call was given slices,
/// pass them here, too.
template <class LightRange> std::string dump(const LightMasks& masks, const View& view, const LightRange& lights) {
    return detail::dump(view, detail::as_lights(lights), nullptr, masks);
}
template <class LightRange>
std::string dump(const LightMasks& masks, const View& view, const LightRange& lights, const Slices& slices) {
    return detail::dump(view, detail::as_lights(lights), &slices, masks);
}

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
