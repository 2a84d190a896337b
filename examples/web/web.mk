# make -f examples/web/web.mk OUT=FOLDER: the page's folder, its objects beside it. Needs what the npm package is built
# with, and GLM, tinygltf and nlohmann-json, where Debian has them.
here := examples/web
OUT := build/web
objects := $(OUT).objects
page := $(filter-out %.mk %.py,$(wildcard $(here)/*.*)) $(wildcard tests/fixtures/*.glb)

# Exceptions as WebAssembly has them, which every browser since 2022 knows. No file is opened by its name,
# and no texture is read.
flags = -std=c++20 -fwasm-exceptions -Wall -Wextra -Werror \
    -DTINYGLTF_NO_FS -DTINYGLTF_NO_STB_IMAGE -DTINYGLTF_NO_STB_IMAGE_WRITE -DTINYGLTF_NO_EXTERNAL_IMAGE \
    -Iinclude -Iexamples/tiled_forward -I$(here)/module -isystem $(objects)/include -O2
package := lightbin.js lightbin.wasm lightbin_simd.wasm shaders.wasm
shared := gpu_light load_glb made_scene made_street moving_lights projection
sources := $(wildcard $(here)/module/*.cpp) $(shared:%=examples/tiled_forward/%.cpp)
compiled := $(patsubst %.cpp,$(objects)/%.o,$(notdir $(sources)))
vpath %.cpp $(here)/module examples/tiled_forward

# It asks for a module that lies where its node does not look.
export NODE_PATH := /usr/share/nodejs

.DELETE_ON_ERROR:

all: $(OUT)/scenes.wasm $(package:%=$(OUT)/lightbin/%) $(addprefix $(OUT)/,$(notdir $(page)))

# lightbin as others use it: the npm package. Of its files, those that the page loads.
$(package:%=$(OUT)/lightbin/%) &: $(objects)/lightbin/package.json | $(OUT)/lightbin
	@cp $(package:%=$(objects)/lightbin/%) $(OUT)/lightbin

$(objects)/lightbin/package.json: $(shell find include packaging/npm -type f)
	@echo "    building the npm package"
	@sh packaging/npm/build.sh $(@D) >$(@D).log 2>&1 || { cat $(@D).log; exit 1; }
	@touch $@

$(OUT)/scenes.wasm: $(compiled) | $(OUT)
	@echo "    linking $(@F)"
	@em++ $(flags) $(compiled) -o $@ -sSTANDALONE_WASM --no-entry -sALLOW_MEMORY_GROWTH

$(objects)/%.o: %.cpp $(here)/web.mk | $(objects)/include
	@echo "    compiling $<"
	@em++ $(flags) -MMD -MP -c $< -o $@

# The host's headers must not be looked at, but for these.
$(objects)/include:
	@mkdir -p $@
	@ln -sf /usr/include/glm /usr/include/nlohmann /usr/include/tiny_gltf.h $@

define copy
$(OUT)/$(notdir $(1)): $(1) | $(OUT)
	@cp $$< $$@
endef
$(foreach file,$(page),$(eval $(call copy,$(file))))

$(OUT) $(OUT)/lightbin:
	@mkdir -p $@

-include $(compiled:.o=.d)
