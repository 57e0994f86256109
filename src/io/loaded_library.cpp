// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/loaded_library.hpp"

#include <meshorder/error.hpp>

#include <dlfcn.h>
#include <fmt/format.h>

namespace meshorder {

void* LoadedLibrary::handle() const {
  void* handle = handle_.load(std::memory_order_acquire);
  if (handle != nullptr) return handle;
  handle = ::dlopen(file_, RTLD_LAZY | RTLD_LOCAL);  // all threads get the same handle
  if (handle == nullptr) {
    const char* const cause = ::dlerror();
    throw Unavailable(
        fmt::format("{} could not be loaded ({}); install it, or convert the mesh to another format", name_,
                    cause != nullptr ? cause : file_));
  }
  handle_.store(handle, std::memory_order_release);
  return handle;
}

void* LoadedLibrary::address_of(const char* symbol) const {
  void* const address = ::dlsym(handle(), symbol);
  if (address == nullptr)
    throw Unavailable(fmt::format("{} ({}) lacks '{}'; install the version that meshorder was built with",
                                  name_, file_, symbol));
  return address;
}

void* LoadedSymbol::address() const {
  void* address = address_.load(std::memory_order_acquire);
  if (address == nullptr) {
    address = library_.address_of(symbol_);
    address_.store(address, std::memory_order_release);
  }
  return address;
}

}  // namespace meshorder
