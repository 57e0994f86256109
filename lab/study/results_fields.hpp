// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <string_view>
#include <tuple>
#include <type_traits>

namespace meshorder {

/// A key of a record's JSON object, and the member that holds its value. Unless `free`, a text must not be
/// empty and a number must not be negative. Earlier versions did not write `optional` keys: if such a key is
/// missing, the member keeps its value.
template <class Record, class Value>
struct Field {
  std::string_view key;
  Value Record::*member;
  bool free = false;
  bool optional = false;
};
// clang 14 cannot deduce the template arguments of an aggregate
template <class Record, class Value>
Field(std::string_view, Value Record::*) -> Field<Record, Value>;
template <class Record, class Value>
Field(std::string_view, Value Record::*, bool) -> Field<Record, Value>;
template <class Record, class Value>
Field(std::string_view, Value Record::*, bool, bool) -> Field<Record, Value>;

/// The keys of a record's JSON object in their order, for reading and writing.
template <class Record>
inline constexpr auto kFields = nullptr;

template <>
inline constexpr auto kFields<OrderingSpec> =
    std::tuple{Field{"name", &OrderingSpec::name}, Field{"title", &OrderingSpec::title},
               Field{"vertices", &OrderingSpec::vertices}, Field{"elements", &OrderingSpec::elements}};

template <>
inline constexpr auto kFields<MachineRecord> =
    std::tuple{Field{"processor", &MachineRecord::processor},
               Field{"cores", &MachineRecord::cores},
               Field{"system", &MachineRecord::system},
               Field{"cache_bytes", &MachineRecord::caches},
               Field{"memory_bytes", &MachineRecord::memory_bytes},
               Field{"read_bandwidth", &MachineRecord::read_bandwidth},
               Field{"read_bandwidth_all", &MachineRecord::read_bandwidth_all},
               Field{"program", &MachineRecord::program},
               Field{"revision", &MachineRecord::revision, true, true},
               Field{"compiler", &MachineRecord::compiler},
               Field{"flags", &MachineRecord::flags, true},
               Field{"simd", &MachineRecord::simd}};

template <>
inline constexpr auto kFields<KernelRecord> = std::tuple{
    Field{"predicted_ms", &KernelRecord::predicted_ms}, Field{"measured_ms", &KernelRecord::measured_ms},
    Field{"accesses", &KernelRecord::accesses}, Field{"misses", &KernelRecord::misses}};

template <>
inline constexpr auto kFields<EdgeSpan> = std::tuple{
    Field{"mean", &EdgeSpan::mean}, Field{"max", &EdgeSpan::max}, Field{"mean_log2", &EdgeSpan::mean_log2}};

template <>
inline constexpr auto kFields<MeshOrderRecord> =
    std::tuple{Field{"ordering", &MeshOrderRecord::ordering},
               Field{"vertex_method", &MeshOrderRecord::vertex_method},
               Field{"element_method", &MeshOrderRecord::element_method},
               Field{"seconds", &MeshOrderRecord::seconds},
               Field{"span", &MeshOrderRecord::span},
               Field{"span_histogram", &MeshOrderRecord::span_histogram},
               Field{"kernels", &MeshOrderRecord::kernels}};

template <>
inline constexpr auto kFields<NamedCaches> =
    std::tuple{Field{"name", &NamedCaches::name}, Field{"cache_bytes", &NamedCaches::caches}};

template <>
inline constexpr auto kFields<MeshRecord> = std::tuple{Field{"name", &MeshRecord::name},
                                                       Field{"file", &MeshRecord::file},
                                                       Field{"vertices", &MeshRecord::vertices},
                                                       Field{"tetrahedra", &MeshRecord::tetrahedra},
                                                       Field{"edges", &MeshRecord::edges},
                                                       Field{"span_bin", &MeshRecord::span_bin},
                                                       Field{"hierarchies", &MeshRecord::hierarchies},
                                                       Field{"orders", &MeshRecord::orders},
                                                       Field{"verdict", &MeshRecord::verdict, true},
                                                       Field{"gain", &MeshRecord::gain, false, true}};

template <>
inline constexpr auto kFields<StepReport::Seconds> =
    std::tuple{Field{"total", &StepReport::Seconds::total},
               Field{"assembly", &StepReport::Seconds::assembly},
               Field{"solve", &StepReport::Seconds::solve},
               Field{"local", &StepReport::Seconds::local},
               Field{"global", &StepReport::Seconds::global},
               Field{"collision", &StepReport::Seconds::collision},
               Field{"triangulation", &StepReport::Seconds::triangulation, false, true},
               Field{"order", &StepReport::Seconds::order, false, true},
               Field{"motion", &StepReport::Seconds::motion, false, true}};

template <>
inline constexpr auto kFields<RunRecord> =
    std::tuple{Field{"began", &RunRecord::began},
               Field{"step_seconds", &RunRecord::step_seconds},
               Field{"seconds", &RunRecord::seconds},
               Field{"cg_iterations", &RunRecord::cg_iterations},
               Field{"admm_iterations", &RunRecord::admm_iterations},
               Field{"contact_iterations", &RunRecord::contact_iterations},
               Field{"setup_seconds", &RunRecord::setup_seconds},
               Field{"bytes", &RunRecord::bytes},
               Field{"other_seconds", &RunRecord::other_seconds, false, true},
               Field{"pace_seconds", &RunRecord::pace_seconds, false, true},
               Field{"warnings", &RunRecord::warnings}};

template <>
inline constexpr auto kFields<TimeSummary> =
    std::tuple{Field{"mean", &TimeSummary::mean}, Field{"deviation", &TimeSummary::deviation},
               Field{"undisturbed", &TimeSummary::undisturbed}};

template <>
inline constexpr auto kFields<Speedup> =
    std::tuple{Field{"saved_seconds", &Speedup::saved_seconds, true},
               Field{"percent", &Speedup::percent, true},
               Field{"low", &Speedup::low, true},
               Field{"high", &Speedup::high, true},
               Field{"beyond_noise", &Speedup::beyond_noise},
               Field{"undisturbed_percent", &Speedup::undisturbed_percent, true},
               Field{"break_even_step", &Speedup::break_even_step}};

template <>
inline constexpr auto kFields<MotionDifference> =
    std::tuple{Field{"by_frame", &MotionDifference::by_frame}, Field{"largest", &MotionDifference::largest}};

template <>
inline constexpr auto kFields<ScenarioOrderRecord> =
    std::tuple{Field{"ordering", &ScenarioOrderRecord::ordering}, Field{"runs", &ScenarioOrderRecord::runs},
               Field{"time", &ScenarioOrderRecord::time}, Field{"speedup", &ScenarioOrderRecord::speedup},
               Field{"motion", &ScenarioOrderRecord::motion}};

template <>
inline constexpr auto kFields<ScenarioRecord> =
    std::tuple{Field{"name", &ScenarioRecord::name},
               Field{"title", &ScenarioRecord::title, true},
               Field{"method", &ScenarioRecord::method},
               Field{"material", &ScenarioRecord::material},
               Field{"precision", &ScenarioRecord::precision, true, true},
               Field{"mesh", &ScenarioRecord::mesh},
               Field{"fingerprint", &ScenarioRecord::fingerprint},
               Field{"steps", &ScenarioRecord::steps},
               Field{"turn", &ScenarioRecord::turn},
               Field{"interleaved", &ScenarioRecord::interleaved},
               Field{"fixed_addresses", &ScenarioRecord::fixed_addresses},
               Field{"processors", &ScenarioRecord::processors},
               Field{"frame_steps", &ScenarioRecord::frame_steps},
               Field{"orders", &ScenarioRecord::orders}};

template <>
inline constexpr auto kFields<StudyResults> =
    std::tuple{Field{"began", &StudyResults::began},         Field{"size", &StudyResults::size},
               Field{"runs", &StudyResults::runs},           Field{"threads", &StudyResults::threads},
               Field{"reference", &StudyResults::reference}, Field{"orderings", &StudyResults::orderings},
               Field{"machine", &StudyResults::machine},     Field{"meshes", &StudyResults::meshes},
               Field{"scenarios", &StudyResults::scenarios}};

/// A record that has kFields.
template <class Type>
concept Described = !std::is_null_pointer_v<std::remove_cv_t<decltype(kFields<Type>)>>;

}  // namespace meshorder
