// SPDX-License-Identifier: MIT
// A Vulkan device under the validation layer that runs one shader at a time.
#pragma once

#include "../job.hpp"
#include "compile.hpp"

#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <vector>

inline void check(VkResult result, const char* what) {
    if (result == VK_SUCCESS) return;
    std::printf("%s: VkResult %d\n", what, static_cast<int>(result));
    std::exit(1);
}

static_assert(lightbin::vk_format(lightbin::TexelFormat::none) == VK_FORMAT_UNDEFINED);
static_assert(lightbin::vk_format(lightbin::TexelFormat::r8ui) == VK_FORMAT_R8_UINT);
static_assert(lightbin::vk_format(lightbin::TexelFormat::r16ui) == VK_FORMAT_R16_UINT);
static_assert(lightbin::vk_format(lightbin::TexelFormat::r32ui) == VK_FORMAT_R32_UINT);
static_assert(lightbin::vk_format(lightbin::TexelFormat::rg32ui) == VK_FORMAT_R32G32_UINT);
static_assert(lightbin::vk_format(lightbin::TexelFormat::r32f) == VK_FORMAT_R32_SFLOAT);

/// Calls what was put in, the last one first.
class Undo {
public:
    Undo() = default;
    Undo(const Undo&) = delete;
    Undo& operator=(const Undo&) = delete;
    ~Undo() {
        while (!steps_.empty()) {
            steps_.back()();
            steps_.pop_back();
        }
    }
    void add(std::function<void()> step) { steps_.push_back(std::move(step)); }

private:
    std::vector<std::function<void()>> steps_;
};

class VulkanDevice {
public:
    VulkanDevice() {
        make_instance();
        choose_device();
        VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, family_};
        pool_ = make(vkCreateCommandPool, vkDestroyCommandPool, pool, "command pool", undo_);
        vertex_ = compile_spirv(R"(#version 450
void main() {
    gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
)",
                                EShLangVertex, false);
    }

    const std::string& name() const { return name_; }

    /// Messages of the validation layer so far; each is printed.
    int messages() const { return messages_; }

    /// Does what the validation layer must complain about, and returns whether it did. That message is not
    /// counted.
    bool validates() {
        expecting_ = true;
        const int before = messages_;
        VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
        info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;  // size 0 is not valid
        VkBuffer buffer = nullptr;
        if (vkCreateBuffer(device_, &info, nullptr, &buffer) == VK_SUCCESS)
            vkDestroyBuffer(device_, buffer, nullptr);
        const bool complained = messages_ > before;
        messages_ = before;
        expecting_ = false;
        return complained;
    }

    /// Returns what the job's shader wrote: the words of its result buffer, or four words a pixel of its
    /// picture. Throws std::runtime_error where glslang refuses the text.
    std::vector<std::uint32_t> run(const Job& job) {
        const std::vector<std::uint32_t> spirv =
            compile_spirv(job.text, job.stage == Stage::compute ? EShLangCompute : EShLangFragment, job.hlsl);
        Undo undo;
        VkCommandBuffer commands = begin(undo);
        const Descriptors descriptors = bind(job, commands, undo);
        const VkShaderModule module = make_module(spirv, undo);
        Buffer result;
        if (job.stage == Stage::compute) {
            result = *descriptors.result;
            const VkPipeline pipeline = compute_pipeline(module, descriptors.layout, undo);
            set(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, descriptors);
            vkCmdDispatch(commands, job.groups[0], job.groups[1], 1);
            barrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                    VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
        } else {
            result = draw(job, commands, module, make_module(vertex_, undo), descriptors, undo);
        }
        finish(commands);
        std::vector<std::uint32_t> words(result.bytes / 4);
        std::memcpy(words.data(), result.mapped, result.bytes);
        return words;
    }

private:
    struct Buffer {
        VkBuffer handle = nullptr;
        void* mapped = nullptr;
        std::size_t bytes = 0;
    };
    struct Image {
        VkImage handle = nullptr;
        VkImageView view = nullptr;
    };
    struct Descriptors {
        VkPipelineLayout layout = nullptr;
        std::vector<VkDescriptorSet> sets;
        const std::vector<std::byte>* push_constants = nullptr;
        const Buffer* result = nullptr;
    };

    static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                     VkDebugUtilsMessageTypeFlagsEXT,
                                                     const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                     void* self) {
        auto& device = *static_cast<VulkanDevice*>(self);
        if (!device.expecting_ && device.messages_ < 10)
            std::printf("validation layer: %s\n", data->pMessage);
        ++device.messages_;
        return VK_FALSE;
    }

    void make_instance() {
        VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
        application.apiVersion = VK_API_VERSION_1_1;
        VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
        messenger.messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
        messenger.messageType =
            VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
        messenger.pfnUserCallback = on_message;
        messenger.pUserData = this;
        const char* layer = "VK_LAYER_KHRONOS_validation";
        const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
        VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
        info.pApplicationInfo = &application;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &layer;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &extension;
        check(vkCreateInstance(&info, nullptr, &instance_), "Vulkan with its validation layer");
        undo_.add([this] { vkDestroyInstance(instance_, nullptr); });
        const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
        check(create(instance_, &messenger, nullptr, &messenger_), "debug messenger");
        undo_.add([this] {
            reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(
                instance_, "vkDestroyDebugUtilsMessengerEXT"))(instance_, messenger_, nullptr);
        });
    }

    void choose_device() {
        std::uint32_t count = 1;  // the first one will do
        if (const VkResult result = vkEnumeratePhysicalDevices(instance_, &count, &physical_);
            result != VK_INCOMPLETE)
            check(result, "Vulkan devices");
        if (count == 0) check(VK_ERROR_INITIALIZATION_FAILED, "there is no Vulkan device");
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(physical_, &properties);
        name_ = properties.deviceName;
        vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
        std::uint32_t families = 8;
        std::array<VkQueueFamilyProperties, 8> family;
        vkGetPhysicalDeviceQueueFamilyProperties(physical_, &families, family.data());
        constexpr VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        while (family_ < families && (family[family_].queueFlags & wanted) != wanted)
            ++family_;
        const float priority = 1;
        VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
        queue.queueFamilyIndex = family_;
        queue.queueCount = 1;
        queue.pQueuePriorities = &priority;
        // Vulkan 1.1 requires a device to have it.
        VkPhysicalDeviceMultiviewFeatures multiview{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES};
        multiview.multiview = VK_TRUE;
        VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
        info.pNext = &multiview;
        info.queueCreateInfoCount = 1;
        info.pQueueCreateInfos = &queue;
        check(vkCreateDevice(physical_, &info, nullptr, &device_), "Vulkan device");
        undo_.add([this] { vkDestroyDevice(device_, nullptr); });
        vkGetDeviceQueue(device_, family_, 0, &queue_);
    }

    /// Creates an object of the device, and destroys it when `undo` is gone.
    template <class Handle, class Info>
    Handle make(VkResult (*create)(VkDevice, const Info*, const VkAllocationCallbacks*, Handle*),
                void (*destroy)(VkDevice, Handle, const VkAllocationCallbacks*), const Info& info, const char* what,
                Undo& undo) {
        Handle handle = nullptr;
        check(create(device_, &info, nullptr, &handle), what);
        undo.add([=, this] { destroy(device_, handle, nullptr); });
        return handle;
    }

    VkShaderModule make_module(std::span<const std::uint32_t> spirv, Undo& undo) {
        VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
        info.codeSize = spirv.size_bytes();
        info.pCode = spirv.data();
        return make(vkCreateShaderModule, vkDestroyShaderModule, info, "shader module", undo);
    }

    VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags properties, Undo& undo) {
        std::uint32_t type = 0;
        while (!(needs.memoryTypeBits & 1u << type) ||
               (memory_.memoryTypes[type].propertyFlags & properties) != properties)
            ++type;
        VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size, type};
        return make(vkAllocateMemory, vkFreeMemory, info, "memory", undo);
    }

    Buffer make_buffer(std::span<const std::byte> data, std::size_t bytes, VkBufferUsageFlags usage,
                       Undo& undo) {
        VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
        info.size = bytes;
        info.usage = usage;
        Buffer buffer;
        buffer.bytes = bytes;
        check(vkCreateBuffer(device_, &info, nullptr, &buffer.handle), "buffer");
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(device_, buffer.handle, &needs);
        const VkDeviceMemory memory =
            allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, undo);
        undo.add([=, this] { vkDestroyBuffer(device_, buffer.handle, nullptr); });
        check(vkBindBufferMemory(device_, buffer.handle, memory, 0), "buffer memory");
        check(vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &buffer.mapped), "map");
        std::memset(buffer.mapped, 0xee, bytes);
        if (!data.empty()) std::memcpy(buffer.mapped, data.data(), data.size());
        return buffer;
    }

    Image make_image(VkFormat format, std::uint32_t width, std::uint32_t height, VkImageUsageFlags usage,
                     Undo& undo, std::uint32_t layers = 1) {
        VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = format;
        info.extent = {width, height, 1};
        info.mipLevels = 1;
        info.arrayLayers = layers;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.tiling = VK_IMAGE_TILING_OPTIMAL;
        info.usage = usage;
        Image image;
        check(vkCreateImage(device_, &info, nullptr, &image.handle), "image");
        VkMemoryRequirements needs;
        vkGetImageMemoryRequirements(device_, image.handle, &needs);
        const VkDeviceMemory memory = allocate(needs, 0, undo);
        undo.add([=, this] { vkDestroyImage(device_, image.handle, nullptr); });
        check(vkBindImageMemory(device_, image.handle, memory, 0), "image memory");
        VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
        view.image = image.handle;
        view.viewType = layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
        view.format = format;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, layers};
        image.view = make(vkCreateImageView, vkDestroyImageView, view, "image view", undo);
        return image;
    }

    static void barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags written,
                        VkPipelineStageFlags to, VkAccessFlags read) {
        const VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, written, read};
        vkCmdPipelineBarrier(commands, from, to, 0, 1, &memory, 0, nullptr, 0, nullptr);
    }

    static void change_layout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to,
                              VkAccessFlags written, VkAccessFlags read) {
        VkImageMemoryBarrier change{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
        change.srcAccessMask = written;
        change.dstAccessMask = read;
        change.oldLayout = from;
        change.newLayout = to;
        change.srcQueueFamilyIndex = change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        change.image = image;
        change.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                             0, 0, nullptr, 0, nullptr, 1, &change);
    }

    VkCommandBuffer begin(Undo& undo) {
        VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool_,
                                         VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
        VkCommandBuffer commands = nullptr;
        check(vkAllocateCommandBuffers(device_, &info, &commands), "command buffer");
        undo.add([=, this] { vkFreeCommandBuffers(device_, pool_, 1, &commands); });
        VkCommandBufferBeginInfo start{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        start.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        check(vkBeginCommandBuffer(commands, &start), "begin");
        return commands;
    }

    void finish(VkCommandBuffer commands) {
        check(vkEndCommandBuffer(commands), "end");
        VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
        submit.commandBufferCount = 1;
        submit.pCommandBuffers = &commands;
        check(vkQueueSubmit(queue_, 1, &submit, nullptr), "submit");
        check(vkQueueWaitIdle(queue_), "wait");
    }

    static VkDescriptorType descriptor_type(const Job& job, lightbin::ShaderResource resource) {
        using lightbin::ShaderResource;
        switch (resource) {
        case ShaderResource::uniform_block:
            return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        case ShaderResource::texel_buffer:
            return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
        case ShaderResource::texture_2d:
            return job.hlsl ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        default:
            return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        }
    }

    // The job's inputs in memory, and descriptor sets that point at them.
    Descriptors bind(const Job& job, VkCommandBuffer commands, Undo& undo) {
        Descriptors descriptors;
        std::vector<std::vector<VkDescriptorSetLayoutBinding>> layouts;
        std::vector<VkDescriptorPoolSize> sizes;
        for (const Input& input : job.inputs) {
            if (input.binding.resource == lightbin::ShaderResource::push_constants) {
                descriptors.push_constants = &input.bytes;
                continue;
            }
            const auto set = static_cast<std::size_t>(input.binding.slot.set);
            if (set >= layouts.size()) layouts.resize(set + 1);
            const VkDescriptorType type = descriptor_type(job, input.binding.resource);
            layouts[set].push_back({static_cast<std::uint32_t>(input.binding.slot.binding), type, 1,
                                    VK_SHADER_STAGE_ALL, nullptr});
            sizes.push_back({type, 1});
        }

        std::vector<VkDescriptorSetLayout> handles;
        for (const auto& layout : layouts) {
            VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
            info.bindingCount = static_cast<std::uint32_t>(layout.size());
            info.pBindings = layout.data();
            handles.push_back(
                make(vkCreateDescriptorSetLayout, vkDestroyDescriptorSetLayout, info, "set layout", undo));
        }
        VkPushConstantRange range{VK_SHADER_STAGE_ALL, 0, 0};
        VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
        layout.setLayoutCount = static_cast<std::uint32_t>(handles.size());
        layout.pSetLayouts = handles.data();
        if (descriptors.push_constants) {
            range.size = static_cast<std::uint32_t>(descriptors.push_constants->size());
            layout.pushConstantRangeCount = 1;
            layout.pPushConstantRanges = &range;
        }
        descriptors.layout = make(vkCreatePipelineLayout, vkDestroyPipelineLayout, layout, "pipeline layout", undo);
        if (handles.empty()) return descriptors;

        VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
        pool.maxSets = static_cast<std::uint32_t>(handles.size());
        pool.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
        pool.pPoolSizes = sizes.data();
        const VkDescriptorPool descriptor_pool =
            make(vkCreateDescriptorPool, vkDestroyDescriptorPool, pool, "descriptor pool", undo);
        descriptors.sets.resize(handles.size());
        const VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr,
                                                     descriptor_pool, pool.maxSets, handles.data()};
        check(vkAllocateDescriptorSets(device_, &allocation, descriptors.sets.data()), "descriptor sets");
        for (const Input& input : job.inputs)
            if (input.binding.resource != lightbin::ShaderResource::push_constants)
                point_at(job, input, descriptors, commands, undo);
        return descriptors;
    }

    void point_at(const Job& job, const Input& input, Descriptors& descriptors, VkCommandBuffer commands,
                  Undo& undo) {
        VkDescriptorBufferInfo buffer_info{nullptr, 0, VK_WHOLE_SIZE};
        VkDescriptorImageInfo image_info{nullptr, nullptr, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        VkBufferView buffer_view = nullptr;
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstSet = descriptors.sets[static_cast<std::size_t>(input.binding.slot.set)];
        write.dstBinding = static_cast<std::uint32_t>(input.binding.slot.binding);
        write.descriptorCount = 1;
        write.descriptorType = descriptor_type(job, input.binding.resource);
        write.pBufferInfo = &buffer_info;
        write.pImageInfo = &image_info;
        write.pTexelBufferView = &buffer_view;
        const VkFormat format = static_cast<VkFormat>(lightbin::vk_format(input.binding.format));
        const Buffer buffer =
            make_buffer(input.bytes, input.bytes.size(),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                            VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                        undo);
        buffer_info.buffer = buffer.handle;
        if (&input == &job.inputs[job.result]) {
            result_ = buffer;
            descriptors.result = &result_;
        }
        if (write.descriptorType == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER) {
            VkBufferViewCreateInfo view{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
            view.buffer = buffer.handle;
            view.format = format;
            view.range = VK_WHOLE_SIZE;
            buffer_view = make(vkCreateBufferView, vkDestroyBufferView, view, "buffer view", undo);
        } else if (input.binding.resource == lightbin::ShaderResource::texture_2d) {
            const Image image =
                make_image(format, input.width, input.height,
                           VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, undo);
            change_layout(commands, image.handle, VK_IMAGE_LAYOUT_UNDEFINED,
                          VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 0, VK_ACCESS_TRANSFER_WRITE_BIT);
            VkBufferImageCopy copy{};
            copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            copy.imageExtent = {input.width, input.height, 1};
            vkCmdCopyBufferToImage(commands, buffer.handle, image.handle,
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
            change_layout(commands, image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_ACCESS_TRANSFER_WRITE_BIT,
                          VK_ACCESS_SHADER_READ_BIT);
            image_info.imageView = image.view;
            if (!job.hlsl) {
                const VkSamplerCreateInfo nearest{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
                image_info.sampler = make(vkCreateSampler, vkDestroySampler, nearest, "sampler", undo);
            }
        }
        vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
    }

    static void set(VkCommandBuffer commands, VkPipelineBindPoint point, VkPipeline pipeline,
                    const Descriptors& descriptors) {
        vkCmdBindPipeline(commands, point, pipeline);
        if (!descriptors.sets.empty())
            vkCmdBindDescriptorSets(commands, point, descriptors.layout, 0,
                                    static_cast<std::uint32_t>(descriptors.sets.size()),
                                    descriptors.sets.data(), 0, nullptr);
        if (descriptors.push_constants)
            vkCmdPushConstants(commands, descriptors.layout, VK_SHADER_STAGE_ALL, 0,
                               static_cast<std::uint32_t>(descriptors.push_constants->size()),
                               descriptors.push_constants->data());
    }

    static VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits which, VkShaderModule module) {
        VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
        info.stage = which;
        info.module = module;
        info.pName = "main";
        return info;
    }

    VkPipeline compute_pipeline(VkShaderModule module, VkPipelineLayout layout, Undo& undo) {
        VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
        info.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, module);
        info.layout = layout;
        VkPipeline pipeline = nullptr;
        check(vkCreateComputePipelines(device_, nullptr, 1, &info, nullptr, &pipeline), "compute pipeline");
        undo.add([=, this] { vkDestroyPipeline(device_, pipeline, nullptr); });
        return pipeline;
    }

    // A triangle over the viewport, which lies at job.corner in a picture that is as much larger; returns the
    // whole picture in a buffer.
    Buffer draw(const Job& job, VkCommandBuffer commands, VkShaderModule fragment, VkShaderModule vertex,
                const Descriptors& descriptors, Undo& undo) {
        const std::uint32_t width = job.width + job.corner[0], height = job.height + job.corner[1];
        const VkFormat format = job.within.empty() ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32G32_SFLOAT;
        const Image image = make_image(format, width, height,
                                       VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                       undo, job.views);
        VkAttachmentDescription attachment{};
        attachment.format = format;
        attachment.samples = VK_SAMPLE_COUNT_1_BIT;
        attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
        attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
        attachment.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
        attachment.finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        VkSubpassDescription subpass{};
        subpass.colorAttachmentCount = 1;
        subpass.pColorAttachments = &reference;
        VkSubpassDependency before_copy{};
        before_copy.srcSubpass = 0;
        before_copy.dstSubpass = VK_SUBPASS_EXTERNAL;
        before_copy.srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
        before_copy.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
        before_copy.dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT;
        before_copy.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
        VkRenderPassCreateInfo pass_info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
        pass_info.attachmentCount = 1;
        pass_info.pAttachments = &attachment;
        pass_info.subpassCount = 1;
        pass_info.pSubpasses = &subpass;
        pass_info.dependencyCount = 1;
        pass_info.pDependencies = &before_copy;
        const std::uint32_t every_view = (1u << job.views) - 1;
        VkRenderPassMultiviewCreateInfo multiview{VK_STRUCTURE_TYPE_RENDER_PASS_MULTIVIEW_CREATE_INFO};
        multiview.subpassCount = 1;
        multiview.pViewMasks = &every_view;
        if (job.views > 1) pass_info.pNext = &multiview;
        const VkRenderPass pass = make(vkCreateRenderPass, vkDestroyRenderPass, pass_info, "render pass", undo);

        VkFramebufferCreateInfo frame{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
        frame.renderPass = pass;
        frame.attachmentCount = 1;
        frame.pAttachments = &image.view;
        frame.width = width;
        frame.height = height;
        frame.layers = 1;
        const VkFramebuffer framebuffer = make(vkCreateFramebuffer, vkDestroyFramebuffer, frame, "framebuffer", undo);

        const VkRect2D whole{{0, 0}, {width, height}};
        const VkViewport viewport{static_cast<float>(job.corner[0]),
                                  static_cast<float>(job.corner[1]),
                                  static_cast<float>(job.width),
                                  static_cast<float>(job.height),
                                  0,
                                  1};
        const VkPipeline pipeline =
            draw_pipeline(vertex, fragment, viewport, whole, descriptors.layout, pass, undo);
        const VkClearValue clear{};
        VkRenderPassBeginInfo start{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
        start.renderPass = pass;
        start.framebuffer = framebuffer;
        start.renderArea = whole;
        start.clearValueCount = 1;
        start.pClearValues = &clear;
        vkCmdBeginRenderPass(commands, &start, VK_SUBPASS_CONTENTS_INLINE);
        set(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline, descriptors);
        vkCmdDraw(commands, 3, 1, 0, 0);
        vkCmdEndRenderPass(commands);

        const Buffer picture =
            make_buffer({}, std::size_t{job.within.empty() ? 16u : 8u} * job.width * job.height * job.views,
                        VK_BUFFER_USAGE_TRANSFER_DST_BIT, undo);
        for (std::uint32_t view = 0; view < job.views; ++view) {
            VkBufferImageCopy copy{};
            copy.bufferOffset = picture.bytes / job.views * view;
            copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, view, 1};
            copy.imageOffset = {static_cast<std::int32_t>(job.corner[0]),
                                static_cast<std::int32_t>(job.corner[1]), 0};
            copy.imageExtent = {job.width, job.height, 1};
            vkCmdCopyImageToBuffer(commands, image.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                   picture.handle, 1, &copy);
        }
        barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
        return picture;
    }

    VkPipeline draw_pipeline(VkShaderModule vertex, VkShaderModule fragment, const VkViewport& viewport,
                             const VkRect2D& scissor, VkPipelineLayout layout, VkRenderPass pass,
                             Undo& undo) {
        const std::array stages = {stage(VK_SHADER_STAGE_VERTEX_BIT, vertex),
                                   stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
        const VkPipelineVertexInputStateCreateInfo no_input{
            VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
        VkPipelineInputAssemblyStateCreateInfo triangles{
            VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
        triangles.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        VkPipelineViewportStateCreateInfo viewports{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
        viewports.viewportCount = viewports.scissorCount = 1;
        viewports.pViewports = &viewport;
        viewports.pScissors = &scissor;
        VkPipelineRasterizationStateCreateInfo raster{
            VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
        raster.lineWidth = 1;
        VkPipelineMultisampleStateCreateInfo samples{
            VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
        samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
        VkPipelineColorBlendAttachmentState write_all{};
        write_all.colorWriteMask = 15;
        VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
        blend.attachmentCount = 1;
        blend.pAttachments = &write_all;
        VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
        info.stageCount = static_cast<std::uint32_t>(stages.size());
        info.pStages = stages.data();
        info.pVertexInputState = &no_input;
        info.pInputAssemblyState = &triangles;
        info.pViewportState = &viewports;
        info.pRasterizationState = &raster;
        info.pMultisampleState = &samples;
        info.pColorBlendState = &blend;
        info.layout = layout;
        info.renderPass = pass;
        VkPipeline pipeline = nullptr;
        check(vkCreateGraphicsPipelines(device_, nullptr, 1, &info, nullptr, &pipeline), "pipeline");
        undo.add([=, this] { vkDestroyPipeline(device_, pipeline, nullptr); });
        return pipeline;
    }

    VkInstance instance_ = nullptr;
    VkDebugUtilsMessengerEXT messenger_ = nullptr;
    VkPhysicalDevice physical_ = nullptr;
    VkPhysicalDeviceMemoryProperties memory_{};
    VkDevice device_ = nullptr;
    VkQueue queue_ = nullptr;
    VkCommandPool pool_ = nullptr;
    std::uint32_t family_ = 0;
    std::string name_;
    std::vector<std::uint32_t> vertex_;
    Buffer result_;
    int messages_ = 0;
    bool expecting_ = false;
    Undo undo_;  // the last member, as its steps use the others
};
