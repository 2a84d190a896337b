// SPDX-License-Identifier: MIT
// Vulkan 1.0: the first GPU that there is, or a device in software.
#include "device.hpp"

#include "../buffer_of.hpp"
#include "../measure.hpp"

#include <compile.hpp>

#include <vulkan/vulkan.h>

#include <array>
#include <cstring>
#include <map>
#include <stdexcept>
#include <utility>

namespace {

void check(VkResult result, const std::string& what) {
    if (result != VK_SUCCESS)
        throw std::runtime_error("Vulkan reports " + std::to_string(static_cast<int>(result)) + " at " +
                                 what);
}

/// Its objects are the process's until the end, those of buffers that are made anew apart: a program opens one device.
class VulkanDevice : public GpuDevice {
public:
    VulkanDevice() {
        VkApplicationInfo application{};
        application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
        application.apiVersion = VK_API_VERSION_1_1;
        VkInstanceCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
        info.pApplicationInfo = &application;
        VkInstance instance = nullptr;
        check(vkCreateInstance(&info, nullptr, &instance), "its start");
        choose_device(instance);
        make_device();
        VkCommandPoolCreateInfo pool{};
        pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        pool.queueFamilyIndex = family_;
        pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
        VkCommandPool commands = nullptr;
        check(vkCreateCommandPool(device_, &pool, nullptr, &commands), "a command pool");
        VkCommandBufferAllocateInfo one{};
        one.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        one.commandPool = commands;
        one.commandBufferCount = 1;
        check(vkAllocateCommandBuffers(device_, &one, &commands_), "a command buffer");
        VkQueryPoolCreateInfo queries{};
        queries.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
        queries.queryCount = most_clocks;
        check(vkCreateQueryPool(device_, &queries, nullptr, &clocks_), "its clock");
    }

    std::string name() const override { return std::string("Vulkan on ") + properties_.deviceName; }
    bool is_software() const override { return properties_.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }
    lightbin::ShaderLanguage language() const override { return lightbin::ShaderLanguage::glsl_vulkan; }

    void make_buffer(const std::string& name, std::size_t bytes) override {
        Buffer& buffer = buffers_[name];
        free(buffer);
        buffer = make_memory(bytes, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    }

    double write(const std::string& name, std::span<const std::byte> bytes) override {
        stage(bytes.size());
        begin();
        // What is read by the clock: the copy alone. The processor's own copy to staging memory is added.
        const double before = time_now();
        std::memcpy(staging_.mapped, bytes.data(), bytes.size());
        const double copied = 1e3 * (time_now() - before);
        clock(0);
        const VkBufferCopy copy{0, 0, bytes.size()};
        vkCmdCopyBuffer(commands_, staging_.handle, buffers_.at(name).handle, 1, &copy);
        barrier();
        clock(1);
        submit();
        return copied + between(0, 1);
    }

    std::vector<std::uint32_t> read(const std::string& name, std::size_t words) override {
        std::vector<std::uint32_t> values(words);
        if (words == 0) return values;
        stage(4 * words);
        begin();
        const VkBufferCopy copy{0, 0, 4 * words};
        vkCmdCopyBuffer(commands_, buffers_.at(name).handle, staging_.handle, 1, &copy);
        barrier();
        submit();
        std::memcpy(values.data(), staging_.mapped, 4 * words);
        return values;
    }

    void set_passes(const std::vector<ComputePass>& passes) override {
        passes_.clear();
        for (const ComputePass& pass : passes)
            passes_.push_back(make_pass(pass));
    }

    std::vector<double> run(bool each_pass) override {
        for (const Pass& pass : passes_)
            bind(pass);
        begin();
        clock(0);
        for (std::size_t i = 0; i < passes_.size(); ++i) {
            const Pass& pass = passes_[i];
            vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pass.pipeline);
            vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pass.layout, 0, 1, &pass.set,
                                    0, nullptr);
            vkCmdDispatch(commands_, pass.of.groups_x, pass.of.groups_y, 1);
            barrier();
            if (each_pass || i + 1 == passes_.size()) clock(i + 1);
        }
        submit();
        if (!each_pass) return {between(0, passes_.size())};
        std::vector<double> milliseconds;
        for (std::size_t i = 0; i < passes_.size(); ++i)
            milliseconds.push_back(between(i, i + 1));
        return milliseconds;
    }

private:
    static constexpr std::uint32_t most_clocks = 16;

    struct Buffer {
        VkBuffer handle = nullptr;
        VkDeviceMemory memory = nullptr;
        void* mapped = nullptr;
        std::size_t bytes = 0;
    };
    struct Pass {
        ComputePass of;
        VkPipelineLayout layout = nullptr;
        VkPipeline pipeline = nullptr;
        VkDescriptorSet set = nullptr;
    };

    void choose_device(VkInstance instance) {
        std::uint32_t count = 8;
        std::array<VkPhysicalDevice, 8> found{};
        const VkResult result = vkEnumeratePhysicalDevices(instance, &count, found.data());
        if (result != VK_INCOMPLETE) check(result, "its devices");
        if (count == 0) throw std::runtime_error("there is no Vulkan device");
        for (std::uint32_t i = 0; i < count; ++i) {
            VkPhysicalDeviceProperties properties;
            vkGetPhysicalDeviceProperties(found[i], &properties);
            if (physical_ != nullptr &&
                (properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU || !is_software()))
                continue;
            physical_ = found[i];
            properties_ = properties;
        }
    }

    void make_device() {
        vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
        std::uint32_t count = 16;
        std::array<VkQueueFamilyProperties, 16> families{};
        vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, families.data());
        constexpr VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        while (family_ < count && ((families[family_].queueFlags & wanted) != wanted ||
                                   families[family_].timestampValidBits == 0))
            ++family_;
        if (family_ == count) throw std::runtime_error(name() + " has no queue with a clock");
        const float priority = 1;
        VkDeviceQueueCreateInfo queue{};
        queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
        queue.queueFamilyIndex = family_;
        queue.queueCount = 1;
        queue.pQueuePriorities = &priority;
        VkDeviceCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
        info.queueCreateInfoCount = 1;
        info.pQueueCreateInfos = &queue;
        check(vkCreateDevice(physical_, &info, nullptr, &device_), "a device");
        vkGetDeviceQueue(device_, family_, 0, &queue_);
    }

    Buffer make_memory(std::size_t bytes, VkMemoryPropertyFlags properties) {
        Buffer buffer;
        buffer.bytes = bytes;
        VkBufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        info.size = bytes;
        info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
        const std::string what = "a buffer of " + std::to_string(bytes) + " bytes";
        check(vkCreateBuffer(device_, &info, nullptr, &buffer.handle), what);
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(device_, buffer.handle, &needs);
        VkMemoryAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        allocate.allocationSize = needs.size;
        while (allocate.memoryTypeIndex < memory_.memoryTypeCount &&
               (!(needs.memoryTypeBits & 1u << allocate.memoryTypeIndex) ||
                (memory_.memoryTypes[allocate.memoryTypeIndex].propertyFlags & properties) != properties))
            ++allocate.memoryTypeIndex;
        if (allocate.memoryTypeIndex == memory_.memoryTypeCount)
            throw std::runtime_error("no memory for " + what);
        check(vkAllocateMemory(device_, &allocate, nullptr, &buffer.memory), what);
        check(vkBindBufferMemory(device_, buffer.handle, buffer.memory, 0), what);
        if (properties & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT)
            check(vkMapMemory(device_, buffer.memory, 0, VK_WHOLE_SIZE, 0, &buffer.mapped), what);
        return buffer;
    }
    void free(Buffer& buffer) {
        if (buffer.handle == nullptr) return;
        vkDestroyBuffer(device_, buffer.handle, nullptr);
        vkFreeMemory(device_, buffer.memory, nullptr);
        buffer = {};
    }
    /// Has so many bytes of memory that the processor writes and reads.
    void stage(std::size_t bytes) {
        if (staging_.bytes >= bytes) return;
        free(staging_);
        staging_ = make_memory(2 * bytes,
                               VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    }

    Pass make_pass(const ComputePass& of) {
        Pass pass = {of};
        std::vector<VkDescriptorSetLayoutBinding> bindings;
        for (const lightbin::ShaderBinding& binding : of.shader.bindings)
            bindings.push_back({static_cast<std::uint32_t>(binding.slot.binding), type_of(binding), 1,
                                VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
        VkDescriptorSetLayoutCreateInfo set{};
        set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
        set.bindingCount = static_cast<std::uint32_t>(bindings.size());
        set.pBindings = bindings.data();
        VkDescriptorSetLayout set_layout = nullptr;
        check(vkCreateDescriptorSetLayout(device_, &set, nullptr, &set_layout), of.name);
        VkPipelineLayoutCreateInfo layout{};
        layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
        layout.setLayoutCount = 1;
        layout.pSetLayouts = &set_layout;
        check(vkCreatePipelineLayout(device_, &layout, nullptr, &pass.layout), of.name);

        const std::vector<std::uint32_t> spirv =
            compile_spirv("#version 450\n" + of.shader.text, EShLangCompute, false);
        VkShaderModuleCreateInfo code{};
        code.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        code.codeSize = 4 * spirv.size();
        code.pCode = spirv.data();
        VkComputePipelineCreateInfo pipeline{};
        pipeline.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
        pipeline.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        pipeline.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        pipeline.stage.pName = "main";
        pipeline.layout = pass.layout;
        check(vkCreateShaderModule(device_, &code, nullptr, &pipeline.stage.module), of.name);
        check(vkCreateComputePipelines(device_, nullptr, 1, &pipeline, nullptr, &pass.pipeline), of.name);

        const std::array sizes = {VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 8},
                                  VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 8}};
        VkDescriptorPoolCreateInfo pool{};
        pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
        pool.maxSets = 1;
        pool.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
        pool.pPoolSizes = sizes.data();
        VkDescriptorPool sets = nullptr;
        check(vkCreateDescriptorPool(device_, &pool, nullptr, &sets), of.name);
        VkDescriptorSetAllocateInfo one{};
        one.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
        one.descriptorPool = sets;
        one.descriptorSetCount = 1;
        one.pSetLayouts = &set_layout;
        check(vkAllocateDescriptorSets(device_, &one, &pass.set), of.name);
        return pass;
    }
    static VkDescriptorType type_of(const lightbin::ShaderBinding& binding) {
        return binding.resource == lightbin::ShaderResource::uniform_block
                   ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                   : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    }
    void bind(const Pass& pass) {
        for (const lightbin::ShaderBinding& binding : pass.of.shader.bindings) {
            const VkDescriptorBufferInfo buffer{buffers_.at(buffer_of(binding)).handle, 0, VK_WHOLE_SIZE};
            VkWriteDescriptorSet write{};
            write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
            write.dstSet = pass.set;
            write.dstBinding = static_cast<std::uint32_t>(binding.slot.binding);
            write.descriptorCount = 1;
            write.descriptorType = type_of(binding);
            write.pBufferInfo = &buffer;
            vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
        }
    }

    void begin() {
        VkCommandBufferBeginInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        check(vkBeginCommandBuffer(commands_, &info), "commands");
        vkCmdResetQueryPool(commands_, clocks_, 0, most_clocks);
    }
    void submit() {
        check(vkEndCommandBuffer(commands_), "commands");
        VkSubmitInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
        info.commandBufferCount = 1;
        info.pCommandBuffers = &commands_;
        check(vkQueueSubmit(queue_, 1, &info, nullptr), "commands");
        check(vkQueueWaitIdle(queue_), "commands");
    }
    void barrier() {
        constexpr VkPipelineStageFlags stages =
            VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
        VkMemoryBarrier memory{};
        memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        memory.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
        memory.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                               VK_ACCESS_UNIFORM_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                               VK_ACCESS_HOST_READ_BIT;
        vkCmdPipelineBarrier(commands_, stages, stages | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &memory, 0,
                             nullptr, 0, nullptr);
    }
    void clock(std::size_t i) {
        vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, clocks_,
                            static_cast<std::uint32_t>(i));
    }
    double between(std::size_t from, std::size_t to) const {
        std::uint64_t begin = 0, end = 0;
        for (const auto& [clock, value] : {std::pair(from, &begin), std::pair(to, &end)})
            check(vkGetQueryPoolResults(device_, clocks_, static_cast<std::uint32_t>(clock), 1, sizeof *value,
                                        value, sizeof *value,
                                        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                  "its clock");
        return static_cast<double>(end - begin) * static_cast<double>(properties_.limits.timestampPeriod) *
               1e-6;
    }

    VkPhysicalDevice physical_ = nullptr;
    VkPhysicalDeviceProperties properties_{};
    VkPhysicalDeviceMemoryProperties memory_{};
    std::uint32_t family_ = 0;
    VkDevice device_ = nullptr;
    VkQueue queue_ = nullptr;
    VkCommandBuffer commands_ = nullptr;
    VkQueryPool clocks_ = nullptr;
    Buffer staging_;
    std::map<std::string, Buffer> buffers_;
    std::vector<Pass> passes_;
};

}  // namespace

std::unique_ptr<GpuDevice> open_vulkan_device() {
    return std::make_unique<VulkanDevice>();
}
