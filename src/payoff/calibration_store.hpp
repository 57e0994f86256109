// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "payoff/calibration.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace meshorder {

/// What a calibration holds for: this processor with these caches, and this build of the program.
struct CalibrationKey {
  std::string processor;
  std::string caches;  ///< as reported, "48K,1M,32M"; empty where the system reports none
  std::string build;

  bool operator==(const CalibrationKey&) const = default;
};

/// Returns the key of this machine and this program.
CalibrationKey key_of_this_machine();

/// Returns the key that a calibration was made for.
CalibrationKey key_of(const Calibration& calibration);

/// Returns the file of a key in user_cache_folder, `calibrations/AMD-EPYC-9R45-0123456789abcdef.json`: the
/// processor's name and a hash of the whole key. Empty if there is no such folder.
std::filesystem::path calibration_file(const CalibrationKey& key);

/// What the cache folder has for a key.
struct StoredCalibration {
  std::optional<Calibration> calibration;
  /// Why a file that is there is not taken, a sentence; empty if it is, and if there is none.
  std::string fault;
};

/// Reads what is stored for a key. A file that cannot be read, is no calibration or is of another key is not
/// taken.
StoredCalibration load_calibration(const CalibrationKey& key);

/// Stores a calibration for its key, beside the file and then in its place, so that other processes see the
/// old one or the new one. Returns the file. Throws Error if that fails or there is no folder for it.
std::filesystem::path save_calibration(const Calibration& calibration);

/// Returns the text of a calibration's file, JSON with the keys of docs/json.md.
std::string to_json_text(const Calibration& calibration);

/// Reads it. Throws InvalidArgument if it is no calibration, a sentence's end: "is no JSON".
Calibration parse_calibration(const std::string& text);

}  // namespace meshorder
