// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"
#include "lab/support/json_value.hpp"

namespace meshorder {

// What a record read from `value` must be beyond the types of its fields. Each throws Error that names the
// place.

/// Levels rise and hold whole lines.
void check_record(const Caches& caches, const JsonValue& value);

/// Misses are those of every hierarchy and level, or none; bins are counted; no order comes twice.
void check_record(const MeshRecord& mesh, const JsonValue& value);

/// Every run has the scenario's steps; every frame its difference, where there are any; no order comes twice.
void check_record(const ScenarioRecord& scenario, const JsonValue& value);

/// Names are unique, and what is referred to is there.
void check_record(const StudyResults& results, const JsonValue& value);

/// Others need no more.
template <class Record>
void check_record(const Record& /*record*/, const JsonValue& /*value*/) {}

}  // namespace meshorder
