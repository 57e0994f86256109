// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Macros of the public headers, not for use elsewhere.

#if __cplusplus < 201709L && !(defined(_MSVC_LANG) && _MSVC_LANG >= 202002L)
#error "meshorder needs C++20: compile with -std=c++20 or newer"
#endif

/// Marks what a shared library exports. Empty for static libraries. `MESHORDER_SHARED` is set by the CMake
/// targets and pkg-config files of shared builds, `MESHORDER_BUILDING` only while the library itself is
/// compiled.
#if !defined(MESHORDER_SHARED)
#define MESHORDER_API
#elif !defined(_WIN32)
#define MESHORDER_API [[gnu::visibility("default")]]
#elif defined(MESHORDER_BUILDING)
#define MESHORDER_API __declspec(dllexport)
#else
#define MESHORDER_API __declspec(dllimport)
#endif

/// Marks a parameter that the result refers to, so that Clang and MSVC warn of a view that outlives its
/// array.
#if defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::lifetimebound)
#define MESHORDER_LIFETIMEBOUND [[clang::lifetimebound]]
#elif __has_cpp_attribute(msvc::lifetimebound)
#define MESHORDER_LIFETIMEBOUND [[msvc::lifetimebound]]
#endif
#endif
#if !defined(MESHORDER_LIFETIMEBOUND)
#define MESHORDER_LIFETIMEBOUND
#endif
