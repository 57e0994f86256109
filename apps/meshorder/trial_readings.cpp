// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "trial_readings.hpp"

#include "io/stream/file_path.hpp"
#include "wording.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <filesystem>

namespace meshorder::command {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::string with_places(const std::string& word, const TrialSubject& subject, const TrialFolder& folder) {
  return replaced(replaced(replaced(word, "{out}", folder.output().string()), "{stem}", subject.stem()), "{}",
                  subject.name());
}

TrialReadings::TrialReadings(const TrialOptions& options, const TrialSubject& subject,
                             const TrialFolder& folder)
    : folder_(folder),
      tolerance_(options.tolerance),
      same_file_(with_places(options.same_file, subject, folder)) {
  if (options.time != "cpu" && options.time != "wall") time_.emplace("--time", options.time);
  if (!options.count.empty()) count_.emplace("--count", options.count);
  if (!options.same.empty()) same_.emplace("--same", options.same);
  const fs::path file = fs::path(options.same_file).lexically_normal();
  if (file.is_absolute() || file.string().starts_with(".."))
    throw InvalidArgument("--same-file " + options.same_file +
                          ": give its path in the folder that the program runs in, or {out}");
}

std::string TrialReadings::read(TriedOrder& order, double& time) {
  const std::vector<fs::path> printed = printed_files(folder_.log());
  if (time_) time = time_->find(printed).back();
  if (time <= 0) throw InvalidArgument(fmt::format("a time of {} cannot be compared", time));
  if (count_) order.count = count_->find(printed).back();
  std::string found;
  if (same_) {
    std::vector<double> numbers = same_->find(printed);
    if (!numbers_) numbers_ = numbers;
    found = difference(*numbers_, numbers, tolerance_);
  }
  if (!same_file_.empty() && found.empty()) {
    const fs::path file = folder_.run() / same_file_;  // an absolute path stays
    if (!fs::is_regular_file(file))
      throw InvalidArgument(fmt::format("--same-file: the program writes no file {}",
                                        file.lexically_relative(folder_.run()).string()));
    std::string text = FilePath(file).read();
    if (!text_) text_ = text;
    found = difference(*text_, text, tolerance_);
  }
  return found;
}

}  // namespace meshorder::command
