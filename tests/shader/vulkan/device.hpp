// SPDX-License-Identifier: MIT
// A Vulkan device under the validation layer that runs one shader at a time.
#pragma once

#include "../job.hpp"
#include "compile.hpp"

// Structs are filled member by member.
#define VULKAN_HPP_NO_CONSTRUCTORS
#include <vulkan/vulkan_raii.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <list>
#include <span>
#include <string>
#include <utility>
#include <vector>

class VulkanDevice {
public:
    VulkanDevice() {
        const vk::PhysicalDeviceMemoryProperties memory = physical_.getMemoryProperties();
        constexpr auto wanted =
            vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent;
        for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type)
            if ((memory.memoryTypes[type].propertyFlags & wanted) == wanted) memory_types_ |= 1u << type;
    }

    std::string name() const { return physical_.getProperties().deviceName; }

    /// Returns the number of messages of the validation layer so far. Each is printed.
    int messages() const { return messages_; }

    /// Makes a mistake that the validation layer must report, and returns whether it did. This message is not counted.
    bool validates() {
        const int before = messages_;
        try {
            const vk::raii::Buffer empty(device_, {.usage = vk::BufferUsageFlagBits::eStorageBuffer});
        } catch (const vk::SystemError&) {
        }
        const bool complained = messages_ > before;
        messages_ = before;
        return complained;
    }

    /// Returns what the job's shader wrote: the words of its result buffer, or four words a pixel of its
    /// picture. Throws std::runtime_error where glslang refuses the text.
    std::vector<std::uint32_t> run(const Job& job) {
        const bool compute = job.stage == Stage::compute;
        const vk::raii::ShaderModule shader =
            make_module(compile_spirv(job.text, compute ? EShLangCompute : EShLangFragment, job.hlsl));
        Frame frame{std::move(
            vk::raii::CommandBuffers(device_, {.commandPool = *pool_, .commandBufferCount = 1})[0])};
        frame.commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
        bind(job, frame);
        const Buffer* const result = compute ? dispatch(job, frame, shader) : draw(job, frame, shader);
        barrier(frame, vk::PipelineStageFlagBits::eHost);
        frame.commands.end();
        const vk::SubmitInfo submit{.commandBufferCount = 1, .pCommandBuffers = &*frame.commands};
        queue_.submit(submit);
        queue_.waitIdle();
        std::vector<std::uint32_t> words(result->bytes / 4);
        std::memcpy(words.data(), result->mapped, result->bytes);
        return words;
    }

private:
    struct Buffer {
        vk::raii::DeviceMemory memory = nullptr;
        vk::raii::Buffer handle = nullptr;
        void* mapped = nullptr;
        std::size_t bytes = 0;
    };
    struct Image {
        vk::raii::DeviceMemory memory = nullptr;
        vk::raii::Image handle = nullptr;
        vk::raii::ImageView view = nullptr;
    };
    /// The Vulkan objects of one run, which must live until it ends.
    struct Frame {
        vk::raii::CommandBuffer commands;
        std::vector<vk::raii::DescriptorSetLayout> layouts = {};
        vk::raii::PipelineLayout layout = nullptr;
        vk::raii::DescriptorPool pool = nullptr;
        std::vector<vk::raii::DescriptorSet> sets = {};
        vk::raii::Pipeline pipeline = nullptr;
        std::list<Buffer> buffers = {};
        std::list<Image> images = {};
        std::list<vk::raii::BufferView> texel_views = {};
        const std::vector<std::byte>* push_constants = nullptr;
        const Buffer* result = nullptr;
    };

    static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                     VkDebugUtilsMessageTypeFlagsEXT,
                                                     const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                     void* count) {
        int& messages = *static_cast<int*>(count);
        if (++messages < 10) std::printf("validation layer: %s\n", data->pMessage);
        return VK_FALSE;
    }

    vk::raii::Instance make_instance() {
        const vk::ApplicationInfo application{.apiVersion = VK_API_VERSION_1_3};
        const char *const layer = "VK_LAYER_KHRONOS_validation", *const extension =
                                                                     VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
        return {context_, vk::InstanceCreateInfo{.pApplicationInfo = &application,
                                                 .enabledLayerCount = 1,
                                                 .ppEnabledLayerNames = &layer,
                                                 .enabledExtensionCount = 1,
                                                 .ppEnabledExtensionNames = &extension}};
    }

    vk::raii::DebugUtilsMessengerEXT make_messenger() {
        using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
        using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
        return {instance_,
                vk::DebugUtilsMessengerCreateInfoEXT{.messageSeverity = Severity::eWarning | Severity::eError,
                                                     .messageType = Type::eValidation,
                                                     .pfnUserCallback = on_message,
                                                     .pUserData = &messages_}};
    }

    /// Uses the first queue family, which can draw and compute on all software devices.
    vk::raii::Device make_device() {
        const float priority = 1;
        const vk::DeviceQueueCreateInfo queue{.queueCount = 1, .pQueuePriorities = &priority};
        vk::PhysicalDeviceVulkan11Features multiview{.multiview = true};
        const vk::PhysicalDeviceVulkan13Features rendering{.pNext = &multiview, .dynamicRendering = true};
        return {physical_, vk::DeviceCreateInfo{
                               .pNext = &rendering, .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue}};
    }

    vk::raii::ShaderModule make_module(std::span<const std::uint32_t> spirv) const {
        return {device_, vk::ShaderModuleCreateInfo{.codeSize = spirv.size_bytes(), .pCode = spirv.data()}};
    }

    vk::raii::DeviceMemory allocate(const vk::MemoryRequirements& needs) const {
        const auto type = static_cast<std::uint32_t>(std::countr_zero(needs.memoryTypeBits & memory_types_));
        return {device_, vk::MemoryAllocateInfo{.allocationSize = needs.size, .memoryTypeIndex = type}};
    }

    const Buffer& make_buffer(Frame& frame, std::span<const std::byte> data, std::size_t bytes) const {
        using enum vk::BufferUsageFlagBits;
        Buffer& buffer = frame.buffers.emplace_back();
        buffer.bytes = bytes;
        buffer.handle = {device_,
                         vk::BufferCreateInfo{.size = bytes,
                                              .usage = eStorageBuffer | eUniformBuffer | eUniformTexelBuffer |
                                                       eTransferSrc | eTransferDst}};
        buffer.memory = allocate(buffer.handle.getMemoryRequirements());
        buffer.handle.bindMemory(*buffer.memory, 0);
        buffer.mapped = buffer.memory.mapMemory(0, VK_WHOLE_SIZE);
        std::memset(buffer.mapped, 0xee, bytes);
        if (!data.empty()) std::memcpy(buffer.mapped, data.data(), data.size());
        return buffer;
    }

    /// Makes an image that stays in the general layout, so that no transitions are needed.
    const Image& make_image(Frame& frame, vk::Format format, vk::Extent3D extent, std::uint32_t layers,
                            vk::ImageUsageFlags usage) const {
        Image& image = frame.images.emplace_back();
        image.handle = {device_, vk::ImageCreateInfo{.imageType = vk::ImageType::e2D,
                                                     .format = format,
                                                     .extent = extent,
                                                     .mipLevels = 1,
                                                     .arrayLayers = layers,
                                                     .usage = usage}};
        image.memory = allocate(image.handle.getMemoryRequirements());
        image.handle.bindMemory(*image.memory, 0);
        const vk::ImageSubresourceRange all{vk::ImageAspectFlagBits::eColor, 0, 1, 0, layers};
        image.view = {device_, vk::ImageViewCreateInfo{.image = *image.handle,
                                                       .viewType = layers > 1 ? vk::ImageViewType::e2DArray
                                                                              : vk::ImageViewType::e2D,
                                                       .format = format,
                                                       .subresourceRange = all}};
        const vk::ImageMemoryBarrier change{.dstAccessMask = every_access,
                                            .newLayout = vk::ImageLayout::eGeneral,
                                            .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                            .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                            .image = *image.handle,
                                            .subresourceRange = all};
        frame.commands.pipelineBarrier(every_stage, every_stage, {}, {}, {}, change);
        return image;
    }

    /// Makes all earlier writes visible to later commands.
    static void barrier(Frame& frame, vk::PipelineStageFlags after = every_stage) {
        const vk::MemoryBarrier all{.srcAccessMask = vk::AccessFlagBits::eMemoryWrite,
                                    .dstAccessMask = every_access};
        frame.commands.pipelineBarrier(every_stage, after, {}, all, {}, {});
    }

    static vk::DescriptorType descriptor_type(const Job& job, lightbin::ShaderResource resource) {
        using lightbin::ShaderResource;
        switch (resource) {
        case ShaderResource::uniform_block:
            return vk::DescriptorType::eUniformBuffer;
        case ShaderResource::texel_buffer:
            return vk::DescriptorType::eUniformTexelBuffer;
        case ShaderResource::texture_2d:
            return job.hlsl ? vk::DescriptorType::eSampledImage : vk::DescriptorType::eCombinedImageSampler;
        default:
            return vk::DescriptorType::eStorageBuffer;
        }
    }

    /// Copies the job's inputs to memory, and makes descriptor sets that point at them.
    void bind(const Job& job, Frame& frame) const {
        std::vector<std::vector<vk::DescriptorSetLayoutBinding>> bindings;
        std::vector<vk::DescriptorPoolSize> sizes;
        for (const Input& input : job.inputs) {
            if (input.binding.resource == lightbin::ShaderResource::push_constants) {
                frame.push_constants = &input.bytes;
                continue;
            }
            const auto set = static_cast<std::size_t>(input.binding.slot.set);
            if (set >= bindings.size()) bindings.resize(set + 1);
            sizes.push_back({descriptor_type(job, input.binding.resource), 1});
            bindings[set].push_back({.binding = static_cast<std::uint32_t>(input.binding.slot.binding),
                                     .descriptorType = sizes.back().type,
                                     .descriptorCount = 1,
                                     .stageFlags = vk::ShaderStageFlagBits::eAll});
        }
        std::vector<vk::DescriptorSetLayout> layouts;
        for (const auto& set : bindings) {
            frame.layouts.emplace_back(device_, vk::DescriptorSetLayoutCreateInfo{
                                                    .bindingCount = static_cast<std::uint32_t>(set.size()),
                                                    .pBindings = set.data()});
            layouts.push_back(*frame.layouts.back());
        }
        const auto sets = static_cast<std::uint32_t>(layouts.size());
        const vk::PushConstantRange range{
            vk::ShaderStageFlagBits::eAll, 0,
            frame.push_constants ? static_cast<std::uint32_t>(frame.push_constants->size()) : 0};
        frame.layout = {device_, vk::PipelineLayoutCreateInfo{.setLayoutCount = sets,
                                                              .pSetLayouts = layouts.data(),
                                                              .pushConstantRangeCount = range.size > 0,
                                                              .pPushConstantRanges = &range}};
        if (layouts.empty()) return;
        frame.pool = {device_, vk::DescriptorPoolCreateInfo{
                                   .flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                   .maxSets = sets,
                                   .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
                                   .pPoolSizes = sizes.data()}};
        frame.sets = vk::raii::DescriptorSets(
            device_,
            {.descriptorPool = *frame.pool, .descriptorSetCount = sets, .pSetLayouts = layouts.data()});
        for (const Input& input : job.inputs)
            if (input.binding.resource != lightbin::ShaderResource::push_constants)
                point_at(job, input, frame);
        barrier(frame);
    }

    void point_at(const Job& job, const Input& input, Frame& frame) const {
        const Buffer& buffer = make_buffer(frame, input.bytes, input.bytes.size());
        if (&input == &job.inputs[job.result]) frame.result = &buffer;
        const auto format = static_cast<vk::Format>(lightbin::vk_format(input.binding.format));
        const vk::DescriptorBufferInfo buffer_info{*buffer.handle, 0, VK_WHOLE_SIZE};
        vk::DescriptorImageInfo image_info{.sampler = *sampler_, .imageLayout = vk::ImageLayout::eGeneral};
        vk::BufferView texel_view;
        if (input.binding.resource == lightbin::ShaderResource::texel_buffer) {
            const vk::BufferViewCreateInfo info{
                .buffer = *buffer.handle, .format = format, .range = VK_WHOLE_SIZE};
            texel_view = *frame.texel_views.emplace_back(device_, info);
        } else if (input.binding.resource == lightbin::ShaderResource::texture_2d) {
            using enum vk::ImageUsageFlagBits;
            const vk::Extent3D extent{input.width, input.height, 1};
            const Image& image = make_image(frame, format, extent, 1, eSampled | eTransferDst);
            const vk::BufferImageCopy copy{.imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1},
                                           .imageExtent = extent};
            frame.commands.copyBufferToImage(*buffer.handle, *image.handle, vk::ImageLayout::eGeneral, copy);
            image_info.imageView = *image.view;
        }
        const vk::WriteDescriptorSet write{
            .dstSet = *frame.sets[static_cast<std::size_t>(input.binding.slot.set)],
            .dstBinding = static_cast<std::uint32_t>(input.binding.slot.binding),
            .descriptorCount = 1,
            .descriptorType = descriptor_type(job, input.binding.resource),
            .pImageInfo = &image_info,
            .pBufferInfo = &buffer_info,
            .pTexelBufferView = &texel_view};
        device_.updateDescriptorSets(write, {});
    }

    static void set(Frame& frame, vk::PipelineBindPoint point) {
        frame.commands.bindPipeline(point, *frame.pipeline);
        std::vector<vk::DescriptorSet> sets;
        for (const vk::raii::DescriptorSet& each : frame.sets)
            sets.push_back(*each);
        if (!sets.empty()) frame.commands.bindDescriptorSets(point, *frame.layout, 0, sets, {});
        if (frame.push_constants)
            frame.commands.pushConstants<std::byte>(*frame.layout, vk::ShaderStageFlagBits::eAll, 0,
                                                    *frame.push_constants);
    }

    static vk::PipelineShaderStageCreateInfo stage(vk::ShaderStageFlagBits which,
                                                   const vk::raii::ShaderModule& shader) {
        return {.stage = which, .module = *shader, .pName = "main"};
    }

    const Buffer* dispatch(const Job& job, Frame& frame, const vk::raii::ShaderModule& shader) const {
        const vk::ComputePipelineCreateInfo info{.stage = stage(vk::ShaderStageFlagBits::eCompute, shader),
                                                 .layout = *frame.layout};
        frame.pipeline = {device_, nullptr, info};
        set(frame, vk::PipelineBindPoint::eCompute);
        frame.commands.dispatch(job.groups[0], job.groups[1], 1);
        return frame.result;
    }

    /// A triangle over the viewport, which lies at job.corner in a picture that is as much larger; returns the viewport's
    /// pixels in a buffer.
    const Buffer* draw(const Job& job, Frame& frame, const vk::raii::ShaderModule& shader) const {
        using enum vk::ImageUsageFlagBits;
        const std::uint32_t width = job.width + job.corner[0], height = job.height + job.corner[1],
                            views = job.views > 1 ? (1u << job.views) - 1 : 0;
        const vk::Format format =
            job.within.empty() ? vk::Format::eR32G32B32A32Uint : vk::Format::eR32G32Sfloat;
        const Image& image =
            make_image(frame, format, {width, height, 1}, job.views, eColorAttachment | eTransferSrc);
        const vk::Rect2D whole{{0, 0}, {width, height}};
        const vk::Viewport viewport{static_cast<float>(job.corner[0]),
                                    static_cast<float>(job.corner[1]),
                                    static_cast<float>(job.width),
                                    static_cast<float>(job.height),
                                    0,
                                    1};
        make_draw_pipeline(frame, shader, format, views, viewport, whole);
        const vk::RenderingAttachmentInfo attachment{.imageView = *image.view,
                                                     .imageLayout = vk::ImageLayout::eGeneral,
                                                     .loadOp = vk::AttachmentLoadOp::eClear,
                                                     .storeOp = vk::AttachmentStoreOp::eStore};
        frame.commands.beginRendering({.renderArea = whole,
                                       .layerCount = 1,
                                       .viewMask = views,
                                       .colorAttachmentCount = 1,
                                       .pColorAttachments = &attachment});
        set(frame, vk::PipelineBindPoint::eGraphics);
        frame.commands.draw(3, 1, 0, 0);
        frame.commands.endRendering();
        barrier(frame);

        const Buffer& picture = make_buffer(
            frame, {}, std::size_t{job.within.empty() ? 16u : 8u} * job.width * job.height * job.views);
        const vk::BufferImageCopy copy{.imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, job.views},
                                       .imageOffset = {static_cast<std::int32_t>(job.corner[0]),
                                                       static_cast<std::int32_t>(job.corner[1]), 0},
                                       .imageExtent = {job.width, job.height, 1}};
        frame.commands.copyImageToBuffer(*image.handle, vk::ImageLayout::eGeneral, *picture.handle, copy);
        return &picture;
    }

    void make_draw_pipeline(Frame& frame, const vk::raii::ShaderModule& shader, vk::Format format,
                            std::uint32_t views, const vk::Viewport& viewport,
                            const vk::Rect2D& scissor) const {
        const std::array stages = {stage(vk::ShaderStageFlagBits::eVertex, vertex_),
                                   stage(vk::ShaderStageFlagBits::eFragment, shader)};
        const vk::PipelineVertexInputStateCreateInfo no_input;
        const vk::PipelineInputAssemblyStateCreateInfo triangles{.topology =
                                                                     vk::PrimitiveTopology::eTriangleList};
        const vk::PipelineViewportStateCreateInfo viewports{
            .viewportCount = 1, .pViewports = &viewport, .scissorCount = 1, .pScissors = &scissor};
        const vk::PipelineRasterizationStateCreateInfo raster{.lineWidth = 1};
        const vk::PipelineMultisampleStateCreateInfo one_sample;
        using enum vk::ColorComponentFlagBits;
        const vk::PipelineColorBlendAttachmentState write_all{.colorWriteMask = eR | eG | eB | eA};
        const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = 1, .pAttachments = &write_all};
        const vk::PipelineRenderingCreateInfo target{
            .viewMask = views, .colorAttachmentCount = 1, .pColorAttachmentFormats = &format};
        const vk::GraphicsPipelineCreateInfo info{.pNext = &target,
                                                  .stageCount = 2,
                                                  .pStages = stages.data(),
                                                  .pVertexInputState = &no_input,
                                                  .pInputAssemblyState = &triangles,
                                                  .pViewportState = &viewports,
                                                  .pRasterizationState = &raster,
                                                  .pMultisampleState = &one_sample,
                                                  .pColorBlendState = &blend,
                                                  .layout = *frame.layout};
        frame.pipeline = {device_, nullptr, info};
    }

    static constexpr vk::PipelineStageFlagBits every_stage = vk::PipelineStageFlagBits::eAllCommands;
    static constexpr vk::AccessFlags every_access =
        vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite;

    int messages_ = 0;
    std::uint32_t memory_types_ = 0;  // a bit for each that the processor reads and writes
    vk::raii::Context context_;
    vk::raii::Instance instance_ = make_instance();
    vk::raii::DebugUtilsMessengerEXT messenger_ = make_messenger();
    vk::raii::PhysicalDevice physical_ = std::move(vk::raii::PhysicalDevices(instance_)[0]);
    vk::raii::Device device_ = make_device();
    vk::raii::Queue queue_{device_, 0, 0};
    vk::raii::CommandPool pool_{device_, vk::CommandPoolCreateInfo{}};
    vk::raii::Sampler sampler_{device_, vk::SamplerCreateInfo{}};  // nearest
    vk::raii::ShaderModule vertex_ = make_module(compile_spirv(R"(#version 450
void main() {
    gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
)",
                                                               EShLangVertex, false));
};
