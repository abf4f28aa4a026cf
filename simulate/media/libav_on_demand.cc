// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/libav_on_demand.h"

#include <dlfcn.h>

#include <array>
#include <stdexcept>
#include <string>

namespace flocklift::internal {
namespace {

void* Load(const char* library) {
  void* handle = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
  if (handle == nullptr) {
    throw std::runtime_error("pictures and films need libav: " + std::string(dlerror()));
  }
  return handle;
}

}  // namespace

void* FindInLibav(const char* name) {
  // The first brings libavcodec and libavutil with it. For good: the program uses them to its end.
  static const std::array<void*, 2> libraries = {
      Load("libavformat.so." AV_STRINGIFY(LIBAVFORMAT_VERSION_MAJOR)),
      Load("libswscale.so." AV_STRINGIFY(LIBSWSCALE_VERSION_MAJOR))};
  for (void* library : libraries) {
    if (void* function = dlsym(library, name)) return function;
  }
  throw std::runtime_error("libav has no " + std::string(name));
}

}  // namespace flocklift::internal
