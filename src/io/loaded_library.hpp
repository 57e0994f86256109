// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace meshorder {

/// A shared library, loaded on first use. Objects of this class need static storage duration. The libraries
/// of file formats load 40 others; loading all at the start would take half of the time of a small task.
class LoadedLibrary {
 public:
  /// @param name  as users know it: "HDF5"
  /// @param file  name by which the system's loader finds the library: "libhdf5.so.103"
  constexpr LoadedLibrary(const char* name, const char* file) noexcept : name_(name), file_(file) {}

  /// Loads the library, unless it is loaded already. Throws Unavailable if it cannot be loaded.
  void load() const { (void)handle(); }

  /// Returns the address of a function or variable. Throws Unavailable if the library cannot be loaded or
  /// lacks the symbol.
  [[nodiscard]] void* address_of(const char* symbol) const;

 private:
  [[nodiscard]] void* handle() const;

  const char* name_;
  const char* file_;
  mutable std::atomic<void*> handle_{nullptr};
};

/// A symbol of a library, found on first use.
class LoadedSymbol {
 public:
  /// @param symbol  name of the symbol in the library
  constexpr LoadedSymbol(const LoadedLibrary& library, const char* symbol) noexcept
      : library_(library), symbol_(symbol) {}

 protected:
  /// Returns the address of the symbol. Throws Unavailable as `LoadedLibrary::address_of` does.
  [[nodiscard]] void* address() const;

 private:
  const LoadedLibrary& library_;
  const char* symbol_;
  mutable std::atomic<void*> address_{nullptr};
};

/// A function of a library. Converts to a function pointer.
template <class Function>
class LoadedFunction : public LoadedSymbol {
 public:
  using LoadedSymbol::LoadedSymbol;
  // NOLINTNEXTLINE(google-explicit-constructor): stands for the function
  operator Function*() const { return reinterpret_cast<Function*>(address()); }
};

/// A variable of a library. Converts to its value.
template <class Value>
class LoadedVariable : public LoadedSymbol {
 public:
  using LoadedSymbol::LoadedSymbol;
  // NOLINTNEXTLINE(google-explicit-constructor): stands for the variable
  operator Value() const { return *static_cast<const Value*>(address()); }
};

}  // namespace meshorder

// Declares a function or a variable of the C library `library` in the enclosing namespace, where it hides the
// library's own declaration. If a function's `name` is a macro of a header, the name that the macro expands
// to is declared.
// NOLINTBEGIN(bugprone-macro-parentheses): names are declared
#define MESHORDER_LOADED_FUNCTION(library, name) MESHORDER_LOADED_FUNCTION_AS(library, name)
#define MESHORDER_LOADED_FUNCTION_AS(library, name) \
  inline constinit const LoadedFunction<decltype(::name)> name { library, #name }
#define MESHORDER_LOADED_VARIABLE(library, name) \
  inline constinit const LoadedVariable<decltype(::name)> name { library, #name }
// NOLINTEND(bugprone-macro-parentheses)
