// SPDX-License-Identifier: MIT
// The reader of glTF. What it leaves out is said where it is compiled, as load_glb.cpp must be told the same.
#include <fstream>  // which it uses even without files

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
