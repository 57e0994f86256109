// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "trial.hpp"

#include "base/text.hpp"
#include "io/stream/file_path.hpp"
#include "program_output.hpp"
#include "trial_folder.hpp"
#include "trial_program.hpp"
#include "try_report.hpp"
#include "wording.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

namespace fs = std::filesystem;

constexpr double kLeastTime = 1e-6;

/// Returns a word of the command line with the mesh in place of {}, its name without extension in place of
/// {stem}, and the path for outputs in place of {out}.
std::string with_places(std::string_view word, const TrialSubject& subject, const TrialFolder& folder) {
  const std::array<std::pair<std::string_view, std::string>, 3> places{
      std::pair{"{}", subject.name()}, {"{stem}", subject.stem()}, {"{out}", folder.output().string()}};
  std::string result;
  while (!word.empty()) {
    const auto place =
        std::ranges::find_if(places, [&](const auto& pair) { return word.starts_with(pair.first); });
    result += place == places.end() ? std::string(1, word.front()) : place->second;
    word.remove_prefix(place == places.end() ? 1 : place->first.size());
  }
  return result;
}

/// Reads the times, counts and results of a program from its printed output and its files.
class TrialReadings {
 public:
  /// Throws InvalidArgument for faulty expressions, and for a --same-file outside the program's folder.
  TrialReadings(const TrialOptions& options, const TrialSubject& subject, const TrialFolder& folder);

  /// Reads the results of a run. Throws InvalidArgument if a requested result is missing or the time is not
  /// above 0. Returns how the results differ from those of the first run; empty if they are the same.
  std::string read(TriedOrder& order, double& time);

 private:
  [[nodiscard]] std::vector<double> found_by(const PrintedNumbers& expression) const;

  const TrialFolder& folder_;
  double tolerance_;
  double timeout_seconds_;
  std::string same_file_;
  std::optional<PrintedNumbers> time_;
  std::optional<PrintedNumbers> count_;
  std::optional<PrintedNumbers> same_;
  std::optional<std::vector<double>> numbers_;  ///< of the first run
  std::optional<std::string> text_;             ///< of the first run
};

TrialReadings::TrialReadings(const TrialOptions& options, const TrialSubject& subject,
                             const TrialFolder& folder)
    : folder_(folder),
      tolerance_(options.tolerance),
      timeout_seconds_(options.timeout_seconds),
      same_file_(with_places(options.same_file, subject, folder)) {
  if (options.time != "cpu" && options.time != "wall") time_.emplace("--time", options.time);
  if (!options.count.empty()) count_.emplace("--count", options.count);
  if (!options.same.empty()) same_.emplace("--same", options.same);
  const fs::path file = fs::path(options.same_file).lexically_normal();
  if (file.is_absolute() || file.string().starts_with(".."))
    throw InvalidArgument("--same-file " + options.same_file +
                          ": give its path in the folder that the program runs in, or {out}");
}

/// Returns the numbers that an expression finds. Matches in a child process: an expression may take forever,
/// and a long line may exhaust the stack.
std::vector<double> TrialReadings::found_by(const PrintedNumbers& expression) const {
  constexpr double kSeconds = 10;
  constexpr double kBytesASecond = 1e6;
  const std::vector<fs::path> printed = printed_files(folder_.log());
  const fs::path result = folder_.log().string() + ".numbers";
  double seconds = kSeconds;
  for (const fs::path& file : printed) seconds += static_cast<double>(fs::file_size(file)) / kBytesASecond;
  seconds = std::min(seconds, timeout_seconds_);
  const TrialRun run = run_in_child(
      [&] {
        std::ofstream file(result);
        file.exceptions(std::ios::failbit | std::ios::badbit);
        try {
          const std::vector<double> numbers = expression.find(printed);
          file << "numbers:";
          for (const double number : numbers) file << fmt::format(" {}", number);
        } catch (const InvalidArgument& fault) {
          file << fault.what();
        }
        file.close();
      },
      seconds);
  if (!run.succeeded()) {
    throw InvalidArgument(
        fmt::format("{}: {}; write an expression without a repetition in a repetition", expression.name(),
                    run.timed_out ? fmt::format("matching it takes more than {}", duration(seconds))
                                  : "matching it fails for lack of memory"));
  }
  const std::string text = FilePath(result).read();
  std::string_view rest = text;
  if (next_word(rest) != "numbers:") throw InvalidArgument(text);
  std::vector<double> numbers;
  for (std::string_view word; !(word = next_word(rest)).empty();) numbers.push_back(number_of(word).value());
  return numbers;
}

std::string TrialReadings::read(TriedOrder& order, double& time) {
  if (time_) time = found_by(*time_).back();
  if (!(time > 0) || std::isinf(time))
    throw InvalidArgument(fmt::format("a time of {} cannot be compared", time));
  if (count_) order.count = found_by(*count_).back();
  if (count_ && !std::isfinite(order.count))
    throw InvalidArgument(fmt::format("a count of {} cannot be compared", order.count));
  std::string found;
  if (same_) {
    std::vector<double> numbers = found_by(*same_);
    const auto is_finite = [](double number) { return std::isfinite(number); };
    if (!numbers_ && !std::ranges::all_of(numbers, is_finite)) {
      throw InvalidArgument(fmt::format("{}: nothing to compare: it captures {}", same_->name(),
                                        *std::ranges::find_if_not(numbers, is_finite)));
    }
    if (!numbers_) numbers_ = numbers;
    found = difference(*numbers_, numbers, tolerance_);
  }
  if (!same_file_.empty() && found.empty()) {
    const fs::path file = folder_.run() / same_file_;  // an absolute path stays
    if (!fs::is_regular_file(file))
      throw InvalidArgument(fmt::format("--same-file: the program writes no file {}",
                                        file.lexically_relative(folder_.run()).string()));
    std::string text = FilePath(file).read();
    if (const std::string fault = why_not_comparable(text); !text_ && !fault.empty()) {
      throw InvalidArgument(fmt::format("--same-file {}: nothing to compare: {}",
                                        file.lexically_relative(folder_.run()).string(), fault));
    }
    if (!text_) text_ = text;
    found = difference(*text_, text, tolerance_);
  }
  return found;
}

/// Runs a program on a mesh in several orders.
class Trial {
 public:
  Trial(const TrialSubject& subject, const TrialOptions& options, Progress& progress)
      : options_(options),
        subject_(subject),
        progress_(progress),
        program_(find_program(options.command.front())),
        folder_(subject.folder(options.with, !options.is_unprotected)),
        readings_(options, subject, folder_) {
    report_.command = options.command;
    report_.call = options.call;
    report_.time = options.time;
    report_.budget_seconds = options.budget_seconds;
    report_.orders.push_back({.name = "original", .methods = {"original", "original"}});
  }

  /// Runs the trial. Throws as `run_trial` does.
  void run() {
    warm_up(0);
    find_orders();
    report_.trials = PairedTrials(report_.orders.size() - 1);
    for (std::size_t i = 1; i < report_.orders.size(); ++i) {
      if (!report_.orders[i].fault.empty()) report_.trials.exclude(i);
    }
    refuse_if_all_fail();
    for (std::vector<std::size_t> round = report_.trials.next_round(); fits(round);
         round = report_.trials.next_round()) {
      const std::string known = known_so_far(report_);
      progress_.stage(
          fmt::format("running in {} orders{}", round.size(), known.empty() ? "" : ", so far " + known),
          report_.run_seconds / options_.budget_seconds, 1);
      std::vector<double> times(report_.orders.size(), 1);
      for (const std::size_t order : round) times[order] = timed_run(order);
      report_.trials.add_round(times);
    }
    refuse_if_all_fail();
    note_differences();
    note_counts();
    note_short_runs();
  }

  [[nodiscard]] const TrialReport& report() const { return report_; }
  [[nodiscard]] const Notes& notes() const { return notes_; }

 private:
  [[nodiscard]] TrialCommand command() const {
    TrialCommand result{.words = {program_},
                        .folder = folder_.run(),
                        .log = folder_.log(),
                        .timeout_seconds = options_.timeout_seconds,
                        .temporary = folder_.temporary(),
                        .protection = folder_.protection()};
    for (auto word = options_.command.begin() + 1; word != options_.command.end(); ++word)
      result.words.push_back(with_places(*word, subject_, folder_));
    return result;
  }

  /// Returns the time of a run. If the run fails, excludes the order or, for the mesh's own order, throws.
  double timed_run(std::size_t number, const fs::path& kept = {}) {
    TriedOrder& order = report_.orders[number];
    const TrialCommand command = this->command();
    folder_.begin_run(number);
    const TrialRun run = run_program(command);
    report_.run_seconds += run.wall_seconds;
    last_seconds_.resize(report_.orders.size());
    last_seconds_[number] = run.wall_seconds;
    if (run.left_behind > 0) {
      const std::string note = "the program leaves processes running, which are ended after each run";
      if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
    }
    double time = std::max(options_.time == "wall" ? run.wall_seconds : run.processor_seconds, kLeastTime);
    try {
      if (!run.succeeded()) throw InvalidArgument(with_remedy(failure_of(run, command)));
      if (!folder_.was_read(number)) throw InvalidArgument(with_remedy(fault_of_reading()));
      const std::string found = readings_.read(order, time);
      order.is_different = !found.empty();
      if (order.is_different) throw InvalidArgument("the results differ: " + found);
    } catch (const InvalidArgument& fault) {
      take_out(number, fault.what());
      time = 1;
    }
    order.peak_bytes = std::max(order.peak_bytes, run.peak_bytes);
    if (order.fault.empty()) order.times.push_back(time);
    folder_.end_run(number, kept);
    return time;
  }

  void take_out(std::size_t number, const std::string& fault) {
    const std::string program = program_name(options_.command);
    if (number == 0 && report_.orders[0].is_different) {
      throw InvalidArgument(
          fmt::format("{}: its results vary from run to run in one order ({}); give a larger --tolerance",
                      program, fault));
    }
    if (number == 0) throw InvalidArgument(fmt::format("{}, in the mesh's own order: {}", program, fault));
    report_.orders[number].fault = fault;
    report_.trials.exclude(number);
  }

  void warm_up(std::size_t number) {
    TriedOrder& order = report_.orders[number];
    progress_.stage(fmt::format("first run in {}", order.name), 0, 0.1);
    const fs::path kept =
        options_.keep.empty() ? fs::path() : fs::absolute(options_.keep) / replaced(order.name, "/", "_");
    (void)timed_run(number, kept);
    order.times.clear();
    if (const std::string line = error_line(folder_.log()); !line.empty() && !has_error_note_) {
      notes_.push_back(with_remedy(fmt::format("the program printed '{}': did it read the mesh?", line)));
      has_error_note_ = true;
    }
  }

  /// Returns the fault of a program that did not read the mesh, with the error that it printed.
  [[nodiscard]] std::string fault_of_reading() const {
    const std::string line = error_line(folder_.log());
    return fmt::format("it did not read its copy of the mesh, {}; have it read {{}}{}",
                       subject_.name() == "." ? "constant/polyMesh" : subject_.name(),
                       line.empty() ? "" : fmt::format("; it printed '{}'", line));
  }

  /// Returns a fault of the program, with a remedy if the fault is known: CalculiX adds .inp to a name; a
  /// protected program cannot write to the originals.
  [[nodiscard]] std::string with_remedy(const std::string& fault) const {
    const bool is_calculix = fs::path(program_).filename().string().starts_with("ccx");
    if (is_calculix && std::ranges::count(options_.command, "{}") > 0)
      return fault + " (CalculiX adds .inp by itself: write {stem} in place of {})";
    const bool is_denied = fault.find("ermission denied") != std::string::npos ||
                           fault.find("peration not permitted") != std::string::npos;
    if (is_denied && folder_.protection() != nullptr)
      return fault +
             " (the program cannot write to the folder of the mesh, nor add files to the folders above: have "
             "it write to {out}, or allow it by --unprotected)";
    return fault;
  }

  void refuse_if_all_fail() const {
    const auto& orders = report_.orders;
    if (orders.size() < 2 || std::any_of(orders.begin() + 1, orders.end(),
                                         [](const TriedOrder& order) { return order.fault.empty(); })) {
      return;
    }
    std::vector<std::string> faults;
    for (auto order = orders.begin() + 1; order != orders.end(); ++order)
      faults.push_back(fmt::format("in {}: {}", order->name, order->fault));
    const bool differ = std::any_of(orders.begin() + 1, orders.end(), std::mem_fn(&TriedOrder::is_different));
    throw InvalidArgument(fmt::format(
        "{} {} only in the mesh's own order; {}{}{}", program_name(options_.command),
        differ ? "gives the same results" : "runs", join(faults, std::string_view("; ")),
        differ
            ? fmt::format("; compare numbers that do not depend on the order, or give a --tolerance larger "
                          "than {:g}",
                          options_.tolerance)
            : "",
        report_.left_out.empty() ? "" : "; --budget leaves no time for " + join(report_.left_out)));
  }

  /// Notes the orders that are excluded because their results differ.
  void note_differences() {
    std::vector<std::string> found;
    for (const TriedOrder& order : report_.orders) {
      if (order.is_different) found.push_back(fmt::format("{} ({})", order.name, order.fault));
    }
    if (found.empty()) return;
    notes_.push_back(fmt::format("left out: {}; --tolerance, now {:g}, allows larger differences",
                                 join(found), options_.tolerance));
  }

  /// Notes the orders in which the number of --count is larger by a tenth or more than in the mesh's own
  /// order.
  void note_counts() {
    constexpr double kMuch = 1.1;
    const double own = report_.orders.front().count;
    std::vector<std::string> found;
    for (const TriedOrder& order : report_.orders) {
      if (order.fault.empty() && own > 0 && order.count >= kMuch * own)
        found.push_back(fmt::format("{:.6g} in {}", order.count, order.name));
    }
    if (found.empty()) return;
    notes_.push_back(
        fmt::format("--count is larger in other orders: {:.6g} in the mesh's own, {}", own, join(found)));
  }

  void note_short_runs() {
    constexpr double kShort = 0.05;
    if (last_seconds_[0] >= kShort) return;
    notes_.push_back(
        fmt::format("a run takes {}, much of it to start the program; a larger mesh gives a clearer result",
                    duration(last_seconds_[0])));
  }

  [[nodiscard]] bool fits(const std::vector<std::size_t>& round) const {
    double seconds = report_.run_seconds;
    for (const std::size_t order : round) seconds += last_seconds_[order];
    return !round.empty() && seconds <= options_.budget_seconds;
  }

  // ---- orders

  /// Makes as many orders as the budget allows and runs the program once in each order. If an order fails,
  /// the next order takes its place. Orders that the user named share the budget, if it allows two runs of
  /// each.
  void find_orders() {
    const bool are_named = !options_.methods.empty();
    const std::vector<std::string> names = are_named ? options_.methods : subject_.orders();
    const double runs = options_.budget_seconds / std::max(last_seconds_[0], kLeastTime);
    const std::size_t most =
        are_named && runs >= 2 * static_cast<double>(names.size() + 1) ? names.size() : orders_that_fit(runs);
    std::size_t sound = 0;
    for (const std::string& name : names) {
      const bool has_time =
          report_.orders.size() == 1 || report_.run_seconds + last_seconds_[0] <= options_.budget_seconds;
      if (sound >= most || !has_time) {
        report_.left_out.push_back(name);
        continue;
      }
      progress_.stage(fmt::format("ordering by {}", name), 0, 0.05);
      const std::size_t number = report_.orders.size();
      add_order(name);
      if (report_.orders.size() == number) continue;
      warm_up(number);
      if (report_.orders[number].fault.empty()) ++sound;
    }
    if (!are_own_.empty()) notes_.push_back("the same as the mesh's own order: " + join(are_own_));
    if (!report_.left_out.empty()) {
      notes_.push_back(fmt::format(
          "there is no time for {}: a run takes {}, and --budget allows {:.0f} run{}", join(report_.left_out),
          duration(last_seconds_[0]), std::floor(runs), std::floor(runs) == 1 ? "" : "s"));
    }
  }

  [[nodiscard]] bool is_there(const MeshMethods& methods) const {
    return std::any_of(report_.orders.begin(), report_.orders.end(), [&](const TriedOrder& order) {
      return order.methods.vertices == methods.vertices && order.methods.elements == methods.elements;
    });
  }

  /// Makes an order and adds it if no equal one exists.
  void add_order(const std::string& name) {
    TriedOrder order{.name = name, .methods = order_named(name), .by_auto = name == "auto"};
    if (is_there(order.methods)) return;
    const std::size_t number = report_.orders.size();
    bool is_own = false;
    try {
      is_own = subject_.make(order, folder_, number);
    } catch (const CommandError& fault) {
      if (order.by_auto || !options_.methods.empty()) throw;
      notes_.push_back(fmt::format("{} is left out: {}", name, fault.what()));
      folder_.drop_order(number);
      return;
    }
    if (is_own) are_own_.push_back(name);
    if (is_own || is_known(number)) {
      folder_.drop_order(number);
    } else {
      report_.orders.push_back(std::move(order));
    }
  }

  /// Completes an order; returns whether an earlier one has equal files.
  bool is_known(std::size_t number) {
    folder_.complete_order(number);
    for (std::size_t other = 1; other < number; ++other) {
      if (folder_.is_same(other, number)) return true;
    }
    return false;
  }

  const TrialOptions& options_;
  const TrialSubject& subject_;
  Progress& progress_;
  std::string program_;
  TrialFolder folder_;
  TrialReadings readings_;
  TrialReport report_;
  Notes notes_;
  std::vector<std::string> are_own_;  ///< names of orders that move nothing
  std::vector<double> last_seconds_;  ///< wall-clock time of each order's last run
  bool has_error_note_ = false;
};

}  // namespace

TrialReport run_trial(const TrialSubject& subject, const TrialOptions& options, Progress& progress,
                      Notes& notes) {
  const TrialSignals signals;
  try {
    Trial trial(subject, options, progress);
    trial.run();
    notes.insert(notes.end(), trial.notes().begin(), trial.notes().end());
    return trial.report();
  } catch (const fs::filesystem_error& error) {
    if (error.code() != std::errc::no_space_on_device) throw;
    throw InputError(
        fs::temp_directory_path().string(), "the disk is full",
        "set TMPDIR to a folder with more room, or name the files that the program needs by --with");
  }
}

}  // namespace meshorder::command
