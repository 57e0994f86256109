// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "trial.hpp"

#include "base/text.hpp"
#include "io/stream/file_path.hpp"
#include "program_output.hpp"
#include "trial_program.hpp"
#include "wording.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

namespace meshorder::command {
namespace {

namespace fs = std::filesystem;

constexpr double kLeastTime = 1e-6;

/// Reads the times, counts and results of a program from what it printed and wrote.
class Readings {
 public:
  explicit Readings(const TrialOptions& options)
      : tolerance_(options.tolerance), same_file_(options.same_file) {
    if (options.time != "cpu" && options.time != "wall") time_.emplace("--time", options.time);
    if (!options.count.empty()) count_.emplace("--count", options.count);
    if (!options.same.empty()) same_.emplace("--same", options.same);
    const fs::path file = fs::path(same_file_).lexically_normal();
    if (same_file_ != "{out}" && (file.is_absolute() || file.string().starts_with("..")))
      throw InvalidArgument("--same-file " + same_file_ +
                            ": give its path in the folder that the program runs in, or {out}");
  }

  /// Throws InvalidArgument if something that was requested is missing. Returns how the results differ from
  /// those of the first run; empty if they are the same.
  std::string read(const TrialFolder& folder, TriedOrder& order, double& time) {
    const std::vector<fs::path> printed{folder.log().string() + ".out", folder.log().string() + ".err"};
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
      const fs::path file = same_file_ == "{out}" ? folder.output() : folder.run() / same_file_;
      if (!fs::is_regular_file(file))
        throw InvalidArgument(fmt::format("--same-file {}: the program writes no such file", same_file_));
      std::string text = FilePath(file).read();
      if (!text_) text_ = text;
      found = difference(*text_, text, tolerance_);
    }
    return found;
  }

 private:
  double tolerance_;
  std::string same_file_;
  std::optional<PrintedNumbers> time_;
  std::optional<PrintedNumbers> count_;
  std::optional<PrintedNumbers> same_;
  std::optional<std::vector<double>> numbers_;  ///< of the first run
  std::optional<std::string> text_;
};

/// Runs a program on a mesh in several orders.
class Trial {
 public:
  Trial(const TrialSubject& subject, const TrialOptions& options, Progress& progress)
      : options_(options),
        subject_(subject),
        progress_(progress),
        readings_(options),
        program_(find_program(options.command.front())),
        folder_(subject.folder(options.with)) {
    report_.command = options.command;
    report_.time = options.time;
    report_.orders.push_back({.name = "original", .methods = {"original", "original"}});
  }

  /// Runs the trial. Throws InvalidArgument if the mesh's own order fails, or if all others do.
  void run() {
    warm_up(0);
    find_orders();
    report_.trials = PairedTrials(report_.orders.size() - 1);
    for (std::size_t i = 1; i < report_.orders.size(); ++i) warm_up(i);
    refuse_if_all_fail();
    for (std::vector<std::size_t> round = report_.trials.next_round(); fits(round);
         round = report_.trials.next_round()) {
      progress_.stage(fmt::format("running in {} orders", round.size()),
                      report_.run_seconds / options_.budget_seconds, 1);
      std::vector<double> times(report_.orders.size(), 1);
      for (const std::size_t order : round) times[order] = timed_run(order);
      report_.trials.add_round(times);
    }
    refuse_if_all_fail();
    note_short_runs();
  }

  [[nodiscard]] const TrialReport& report() const { return report_; }
  [[nodiscard]] const Notes& notes() const { return notes_; }

 private:
  // runs of the best order: a warm-up, rounds to choose among the orders, and pairs; then runs of each order
  static constexpr double kRunsOfBest = 15;
  static constexpr double kRunsOfEach = 3;

  [[nodiscard]] TrialCommand command() const {
    TrialCommand result{.words = {program_},
                        .folder = folder_.run(),
                        .log = folder_.log(),
                        .timeout_seconds = options_.timeout_seconds};
    for (auto word = options_.command.begin() + 1; word != options_.command.end(); ++word) {
      result.words.push_back(
          replaced(replaced(replaced(*word, "{out}", folder_.output().string()), "{stem}", subject_.stem()),
                   "{}", subject_.name()));
    }
    return result;
  }

  /// Returns the time of a run. If the run fails, excludes the order from the trial.
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
      if (!run.succeeded()) throw InvalidArgument(failure_of(run, command));
      const std::string found = readings_.read(folder_, order, time);
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
    const std::string program = fs::path(program_).filename().string();
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
  }

  void refuse_if_all_fail() const {
    const auto& orders = report_.orders;
    if (orders.size() < 2 || std::any_of(orders.begin() + 1, orders.end(),
                                         [](const TriedOrder& order) { return order.fault.empty(); })) {
      return;
    }
    throw InvalidArgument(fmt::format("{} runs in no other order than the mesh's own; in {}: {}",
                                      fs::path(program_).filename().string(), orders[1].name,
                                      orders[1].fault));
  }

  void note_short_runs() {
    constexpr double kShort = 0.05;
    if (last_seconds_[0] >= kShort) return;
    notes_.push_back(
        fmt::format("a run takes {}, of which much is the start of the program; a larger mesh says more",
                    duration(last_seconds_[0])));
  }

  [[nodiscard]] bool fits(const std::vector<std::size_t>& round) const {
    double seconds = report_.run_seconds;
    for (const std::size_t order : round) seconds += last_seconds_[order];
    return !round.empty() && seconds <= options_.budget_seconds;
  }

  // ---- orders

  /// Makes the orders, as many as the budget allows.
  void find_orders() {
    const std::vector<std::string> names = options_.methods.empty() ? subject_.orders() : options_.methods;
    const double runs = options_.budget_seconds / std::max(last_seconds_[0], kLeastTime);
    const auto most =
        static_cast<std::size_t>(std::max(1.0, (std::min(runs, 1e6) - kRunsOfBest) / kRunsOfEach));
    for (const std::string& name : names) {
      if (report_.orders.size() > most) {
        report_.left_out.push_back(name);
      } else {
        progress_.stage(fmt::format("ordering by {}", name), 0, 0.05);
        add_order(name);
      }
    }
    if (!are_own_.empty()) notes_.push_back("no other order than the mesh's own: " + join(are_own_));
    if (!report_.left_out.empty()) {
      notes_.push_back(fmt::format("there is no time for {}: a run takes {}, and --budget allows {:.0f}",
                                   join(report_.left_out), duration(last_seconds_[0]), runs));
    }
  }

  [[nodiscard]] bool is_there(const MeshMethods& methods) const {
    return std::any_of(report_.orders.begin(), report_.orders.end(), [&](const TriedOrder& order) {
      return order.methods.vertices == methods.vertices && order.methods.elements == methods.elements;
    });
  }

  /// Makes an order, unless an equal one exists.
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

  /// Returns whether an earlier order has the same files.
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
  Readings readings_;
  std::string program_;
  TrialFolder folder_;
  TrialReport report_;
  Notes notes_;
  std::vector<std::string> are_own_;  ///< names of orders that move nothing
  std::vector<double> last_seconds_;  ///< wall-clock time of each order's last run
};

}  // namespace

TrialReport run_trial(const TrialSubject& subject, const TrialOptions& options, Progress& progress,
                      Notes& notes) {
  const TrialSignals signals;
  Trial trial(subject, options, progress);
  trial.run();
  notes.insert(notes.end(), trial.notes().begin(), trial.notes().end());
  return trial.report();
}

}  // namespace meshorder::command
