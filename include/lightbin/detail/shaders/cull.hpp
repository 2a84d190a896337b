// SPDX-License-Identifier: MIT
// cull_shader(), which generates the text of a compute pass by the functions of cull_project.hpp, cull_lists.hpp and
// cull_masks.hpp.
#pragma once

#include <lightbin/detail/shaders/cull_lists.hpp>
#include <lightbin/detail/shaders/cull_masks.hpp>
#include <lightbin/detail/shaders/cull_plan.hpp>
#include <lightbin/detail/shaders/cull_project.hpp>
#include <lightbin/shader_cull.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

inline Result<ShaderText> cull_shader(CullPass pass, const CullOptions& options) {
    using namespace detail;
    if (const auto error = refuse_cull(options)) return *error;
    ShaderWriter writer(options.language, options.prefix);
    declare_cull_constants(writer, options);
    switch (pass) {
    case CullPass::project:
        add_project(writer, options);
        break;
    case CullPass::sums:
        add_sums(writer, options);
        break;
    case CullPass::offsets:
        add_offsets(writer, options);
        break;
    case CullPass::masks:
        add_masks(writer, options);
        break;
    case CullPass::count:
    case CullPass::fill:
        add_lists(writer, options, pass == CullPass::fill);
    }
    writer.add_compute_main(cull_threads(pass));
    return writer.finish();
}

}}  // namespace lightbin
