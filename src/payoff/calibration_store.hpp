// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "payoff/calibration.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace meshorder {

/// What a calibration is valid for: a processor, its reported caches and a build of the program.
struct CalibrationKey {
  std::string processor;
  std::string caches;  ///< that the system reports, "48K,1M,32M"; empty if it reports none
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

/// A stored calibration, or the reason why the stored file cannot be used.
struct StoredCalibration {
  std::optional<Calibration> calibration;
  /// Why an existing file is not used, a sentence; empty if it is used or there is no file.
  std::string fault;
};

/// Reads the calibration stored for a key. A file is not used if it cannot be read, is not a calibration or
/// has another key.
StoredCalibration load_calibration(const CalibrationKey& key);

/// Stores a calibration for its key. Writes a temporary file and then replaces the old one, so that other
/// processes see either the old file or the new one, complete. Returns the file. Throws Error if that fails
/// or there is no folder.
std::filesystem::path save_calibration(const Calibration& calibration);

/// Returns the text of a calibration's file, JSON with the keys of docs/json.md.
std::string to_json_text(const Calibration& calibration);

/// Reads the text of a calibration's file. Throws InvalidArgument if it is invalid; the message is the end of
/// a sentence ("is not JSON").
Calibration parse_calibration(const std::string& text);

}  // namespace meshorder
