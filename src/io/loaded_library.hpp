// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace meshorder {

/// A shared library that is loaded when something in it is first needed: those of file formats load 40
/// others, which would take half of the time that a small task takes. For objects with static storage
/// duration.
class LoadedLibrary {
 public:
  /// @param name  as users know it: "HDF5"
  /// @param file  name that the system's loader finds it by: "libhdf5.so.103"
  constexpr LoadedLibrary(const char* name, const char* file) noexcept : name_(name), file_(file) {}

  /// Loads the library, unless it is loaded already. Throws Unavailable if the loader does not find it.
  void load() const { (void)handle(); }

  /// Returns the address of a function or variable. Throws Unavailable if the library is not found or lacks
  /// it.
  [[nodiscard]] void* address_of(const char* symbol) const;

 private:
  [[nodiscard]] void* handle() const;

  const char* name_;
  const char* file_;
  mutable std::atomic<void*> handle_{nullptr};
};

/// Something in a library, found when it is first needed.
template <class Thing, const LoadedLibrary& library>
class Loaded {
 public:
  /// @param symbol  its name in the library
  constexpr explicit Loaded(const char* symbol) noexcept : symbol_(symbol) {}

 protected:
  [[nodiscard]] Thing* address() const {
    void* found = address_.load(std::memory_order_acquire);
    if (found == nullptr) {
      found = library.address_of(symbol_);
      address_.store(found, std::memory_order_release);
    }
    return reinterpret_cast<Thing*>(found);
  }

 private:
  const char* symbol_;
  mutable std::atomic<void*> address_{nullptr};
};

/// A function of a library, to be called and passed on like it.
template <class Function, const LoadedLibrary& library>
class LoadedFunction : public Loaded<Function, library> {
 public:
  using Loaded<Function, library>::Loaded;
  // NOLINTNEXTLINE(google-explicit-constructor): stands for the function
  operator Function*() const { return this->address(); }
};

/// A variable of a library, to be read like it.
template <class Value, const LoadedLibrary& library>
class LoadedVariable : public Loaded<Value, library> {
 public:
  using Loaded<Value, library>::Loaded;
  // NOLINTNEXTLINE(google-explicit-constructor): stands for the variable
  operator Value() const { return *this->address(); }
};

}  // namespace meshorder

// Declares a function or a variable of the C library `library` in the enclosing namespace, where it hides the
// library's own. Headers that turn the name into another by a macro are obeyed.
#define MESHORDER_LOADED_FUNCTION(library, name) MESHORDER_LOADED_FUNCTION_AS(library, name)
#define MESHORDER_LOADED_FUNCTION_AS(library, name) \
  inline constinit const LoadedFunction<decltype(::name), library> name { #name }
#define MESHORDER_LOADED_VARIABLE(library, name) \
  inline constinit const LoadedVariable<decltype(::name), library> name { #name }
