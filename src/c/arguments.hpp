// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/status.hpp"
#include "c/structures.hpp"
#include <meshorder/error.hpp>
#include <meshorder/order.hpp>
#include <meshorder/view.hpp>

#include <meshorder.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Converts arrays and structures of callers in C. The functions throw InvalidArgument, with the name of the
// argument, for arguments that they do not accept.

namespace meshorder::c {

/// Returns the message of this thread's last failure.
std::string& last_error();

/// Calls `work()` and returns its status; if it fails, `mo_last_error` returns the reason.
template <class Work>
mo_status guarded(const Work& work) noexcept {
  return status_of(work, last_error());
}

[[noreturn]] void fail(const std::string& name, const std::string& fault);

// Input arrays.

/// Returns a view of integers; an empty view if there is no array.
IndexView integers(const mo_in* array, const char* name);
/// Returns a view of real numbers; an empty view if there is no array.
RealView reals(const mo_in* array, const char* name);
PointsView points_of(const mo_in* array, int dimension);
/// Returns offsets; throws if there are none.
IndexView offsets_of(const mo_in* array, const char* name);
/// Returns VTK's cell types; throws for a number that does not fit a byte.
std::vector<std::uint8_t> types_of(const mo_in* array);
GraphView graph_of(const mo_in* offsets, const mo_in* neighbours, const mo_in* weights, int base);

// Output arrays.

/// Throws unless the array is null (not wanted), or has an integer type and exactly `count` numbers.
void check_integers(const mo_out* array, std::size_t count, const char* name);
/// The same for real numbers.
void check_reals(const mo_out* array, std::size_t count, const char* name);

/// Writes numbers, each plus `base`, into an array that `check_integers` accepted; does nothing if the array
/// is null.
///
/// @param count  greater than every number
/// @throws TooLarge if the type of the array cannot hold count − 1 + base
void write(std::span<const Index> numbers, std::size_t count, int base, const mo_out* array,
           const char* name);
/// The same for a permutation of 0 … size − 1.
inline void write(std::span<const Index> map, int base, const mo_out* array, const char* name) {
  write(map, map.size(), base, array, name);
}
/// Writes numbers into an array that `check_reals` accepted; does nothing if the array is null.
void write(std::span<const double> values, const mo_out* array);

// Options.

/// Returns the caller's options, with defaults for the fields that the caller's older header lacks.
mo_options complete_options(const mo_options* given);
int base_of(std::int32_t base);
OrderOptions order_options(const mo_options& given);
inline std::string_view name_or_auto(const char* method) { return method != nullptr ? method : "auto"; }

}  // namespace meshorder::c
