// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"

#include <filesystem>
#include <string>
#include <utility>

namespace meshorder::distributed {

/// A store with one file in memory, under any path: the input of a reader or the output of a writer.
class TextStore : public FileStore {
 public:
  TextStore() = default;
  explicit TextStore(std::string text) : text_(std::move(text)) {}

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

  [[nodiscard]] bool has(const std::filesystem::path& /*path*/) const override { return true; }
  [[nodiscard]] std::string read(const std::filesystem::path& /*path*/) const override { return text_; }
  void write(const std::filesystem::path& /*path*/, std::string bytes) override { text_ = std::move(bytes); }

 private:
  std::string text_;
};

}  // namespace meshorder::distributed
