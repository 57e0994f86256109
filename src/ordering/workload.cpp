// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include <meshorder/options.hpp>

#include <array>
#include <utility>

// The names of workloads.

namespace meshorder {

template <>
struct EnumNames<Workload> {
  static constexpr std::string_view kind = "workload";
  static constexpr std::array names{
      std::pair{Workload::all, "all"},         std::pair{Workload::element, "element"},
      std::pair{Workload::spmv, "spmv"},       std::pair{Workload::assembly, "assembly"},
      std::pair{Workload::springs, "springs"}, std::pair{Workload::bandwidth, "bandwidth"},
      std::pair{Workload::fill, "fill"},       std::pair{Workload::gpu, "gpu"},
  };
};

inline namespace v0_3 {

std::string_view to_string(Workload workload) { return to_string<Workload>(workload); }
Workload parse_workload(std::string_view name) { return parse<Workload>(name); }

}  // namespace v0_3
}  // namespace meshorder
