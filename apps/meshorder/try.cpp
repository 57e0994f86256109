// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "command.hpp"
#include "console.hpp"
#include "io/format.hpp"
#include "io/stream/file_path.hpp"
#include "payoff/paired_trials.hpp"
#include "payoff/quantities.hpp"
#include "program_output.hpp"
#include "progress.hpp"
#include "trial_folder.hpp"
#include "trial_program.hpp"
#include "try_report.hpp"
#include <meshorder/error.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

namespace fs = std::filesystem;

constexpr int kFaultyInput = 2;
constexpr double kLeastTime = 1e-6;
constexpr std::array kDefaultOrders{"auto", "hilbert", "rcm", "spectral-fronts", "hilbert-fronts"};
// options of `order` that are passed on to it
constexpr std::array kPassedOn{"--for", "--seed", "--limit-memory", "--allow-includes-from", "--trust"};

struct TryArguments : Common {
  std::string input;
  std::vector<std::string> command;
  std::vector<std::string> methods;  ///< empty: kDefaultOrders
  std::vector<std::string> with;
  std::vector<std::string> to_order;  ///< options that are passed on to `order`
  OrderOptions ordering;
  std::string ids = "renumber";
  std::string time = "cpu";
  std::string count;
  std::string same;
  std::string same_file;
  std::string keep;
  double tolerance = 1e-6;
  double budget_seconds = 120;
  double timeout_seconds = 600;
};

/// Returns `text` with `with` in place of each `what`.
std::string replaced(std::string text, std::string_view what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
  return text;
}

/// Throws InvalidArgument for an order that there is not.
void check_order(const std::string& name) {
  const OrderNames methods = order_named(name);
  const auto is_in = [](const std::vector<MethodInfo>& known, const std::string& method) {
    return std::any_of(known.begin(), known.end(),
                       [&](const MethodInfo& info) { return info.name == method; });
  };
  if (!is_in(vertex_methods(), methods.vertices) || !is_in(element_methods(), methods.elements))
    throw InvalidArgument(
        fmt::format("--methods {}: there is no such order; meshorder methods lists them", name));
}

/// What a program prints and writes, as far as it is looked at.
class Readings {
 public:
  explicit Readings(const TryArguments& arguments)
      : tolerance_(arguments.tolerance), same_file_(arguments.same_file) {
    if (arguments.time != "cpu" && arguments.time != "wall") time_.emplace("--time", arguments.time);
    if (!arguments.count.empty()) count_.emplace("--count", arguments.count);
    if (!arguments.same.empty()) same_.emplace("--same", arguments.same);
    const fs::path file = fs::path(same_file_).lexically_normal();
    if (same_file_ != "{out}" && (file.is_absolute() || file.string().starts_with("..")))
      throw InvalidArgument("--same-file " + same_file_ +
                            ": give its path in the folder that the program runs in, or {out}");
  }

  /// Throws InvalidArgument if something that is asked for is not there. Returns why the results are not
  /// those of the first run, empty if they are.
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
  Trial(const TryArguments& arguments, Progress& progress)
      : arguments_(arguments),
        progress_(progress),
        readings_(arguments),
        program_(find_program(arguments.command.front())),
        folder_(arguments.input, arguments.with) {
    report_.input = arguments.input;
    report_.command = arguments.command;
    report_.time = arguments.time;
    report_.ids = arguments.ids;
    report_.orders.push_back({.name = "original", .methods = {"original", "original"}});
  }

  /// Runs the trial. Throws InvalidArgument for faults of the file's own order, or of all others.
  void run() {
    warm_up(0);
    find_orders();
    report_.trials = PairedTrials(report_.orders.size() - 1);
    for (std::size_t i = 1; i < report_.orders.size(); ++i) warm_up(i);
    refuse_if_all_fail();
    for (std::vector<std::size_t> round = report_.trials.next_round(); fits(round);
         round = report_.trials.next_round()) {
      progress_.stage(fmt::format("running in {} orders", round.size()),
                      report_.run_seconds / arguments_.budget_seconds, 1);
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
  // a warm-up, some rounds to choose among the orders, and some pairs for the best
  static constexpr double kRunsOfBest = 15;
  static constexpr double kRunsOfEach = 3;

  [[nodiscard]] std::string file_name() const { return fs::path(arguments_.input).filename().string(); }

  [[nodiscard]] TrialCommand command() const {
    TrialCommand result{.words = {program_},
                        .folder = folder_.run(),
                        .log = folder_.log(),
                        .timeout_seconds = arguments_.timeout_seconds};
    const std::string stem = without_gz(file_name()).stem().string();
    for (auto word = arguments_.command.begin() + 1; word != arguments_.command.end(); ++word) {
      result.words.push_back(replaced(
          replaced(replaced(*word, "{out}", folder_.output().string()), "{stem}", stem), "{}", file_name()));
    }
    return result;
  }

  /// Returns the time of a run; takes the order out of the trial if it does not succeed.
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
    double time = std::max(arguments_.time == "wall" ? run.wall_seconds : run.processor_seconds, kLeastTime);
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
    if (number == 0) throw InvalidArgument(fmt::format("{}, in the file's own order: {}", program, fault));
    report_.orders[number].fault = fault;
    report_.trials.exclude(number);
  }

  void warm_up(std::size_t number) {
    TriedOrder& order = report_.orders[number];
    progress_.stage(fmt::format("first run in {}", order.name), 0, 0.1);
    const fs::path kept =
        arguments_.keep.empty() ? fs::path() : fs::absolute(arguments_.keep) / replaced(order.name, "/", "_");
    (void)timed_run(number, kept);
    order.times.clear();
  }

  void refuse_if_all_fail() const {
    const auto& orders = report_.orders;
    if (orders.size() < 2 || std::any_of(orders.begin() + 1, orders.end(),
                                         [](const TriedOrder& order) { return order.fault.empty(); })) {
      return;
    }
    throw InvalidArgument(fmt::format("{} runs in no other order than the file's own; in {}: {}",
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
    return !round.empty() && seconds <= arguments_.budget_seconds;
  }

  // ---- orders

  /// Makes the orders, as many as the budget allows.
  void find_orders() {
    std::vector<std::string> names = arguments_.methods;
    if (names.empty()) names.assign(kDefaultOrders.begin(), kDefaultOrders.end());
    const double runs = arguments_.budget_seconds / std::max(last_seconds_[0], kLeastTime);
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
    if (!are_own_.empty()) notes_.push_back("no other order than the file's own: " + join(are_own_));
    if (!report_.left_out.empty()) {
      notes_.push_back(fmt::format("there is no time for {}: a run takes {}, and --budget allows {:.0f}",
                                   join(report_.left_out), duration(last_seconds_[0]), runs));
    }
  }

  [[nodiscard]] bool is_there(const OrderNames& methods) const {
    return std::any_of(report_.orders.begin(), report_.orders.end(), [&](const TriedOrder& order) {
      return order.methods.vertices == methods.vertices && order.methods.elements == methods.elements;
    });
  }

  /// Has `meshorder order` write the mesh in another order, unless that is one of those that there are.
  void add_order(const std::string& name) {
    TriedOrder order{.name = name, .methods = order_named(name), .by_auto = name == "auto"};
    if (is_there(order.methods)) return;
    const std::size_t number = report_.orders.size();
    const fs::path output = folder_.add_order(number) / file_name();
    const TrialCommand command = ordering(order, output);
    const TrialRun run = run_program(command);
    if (!run.succeeded()) {
      const std::string line = replaced(fault_of_order(run, command), output.string(), arguments_.input);
      if (order.by_auto || !arguments_.methods.empty()) throw CommandError(line, kFaultyInput);
      notes_.push_back(fmt::format("{} is left out: {}", name, line));
      folder_.drop_order(number);
      return;
    }
    const auto made = nlohmann::json::parse(FilePath(folder_.log().string() + ".out").read());
    for (const auto& seconds : made["seconds"]) order.order_seconds += seconds.get<double>();
    folder_.complete_order(number);
    if (order.by_auto) name_by_methods(order, made);
    const bool is_own = made["vertices"]["kept"].get<bool>() && made["cells"]["kept"].get<bool>();
    bool is_known = is_own;
    for (std::size_t other = 1; other < number; ++other)
      is_known = is_known || folder_.is_same(other, number);
    if (is_own) are_own_.push_back(name);
    if (is_known) {
      folder_.drop_order(number);
    } else {
      report_.orders.push_back(std::move(order));
    }
  }

  [[nodiscard]] TrialCommand ordering(const TriedOrder& order, const fs::path& output) const {
    const bool by_auto = order.by_auto;
    TrialCommand command{.words = {own_program(), "order", fs::absolute(arguments_.input).string(), "-o",
                                   output.string(), "--vertices", order.methods.vertices, "--elements",
                                   by_auto ? "auto" : order.methods.elements, "--ids", arguments_.ids,
                                   "--threads", std::to_string(arguments_.threads), "--json", "--quiet"},
                         .folder = fs::current_path(),
                         .log = folder_.log()};
    command.words.insert(command.words.end(), arguments_.to_order.begin(), arguments_.to_order.end());
    return command;
  }

  /// Returns the error of `meshorder order`, without the program's name.
  static std::string fault_of_order(const TrialRun& run, const TrialCommand& command) {
    constexpr std::string_view kName = "meshorder: ";
    const std::string failure = failure_of(run, command);
    const std::size_t at = failure.find(kName);
    return at == std::string::npos ? failure : failure.substr(at + kName.size());
  }

  /// Gives an order that `auto` chose the names of its methods.
  static void name_by_methods(TriedOrder& order, const nlohmann::json& made) {
    order.methods = {made["vertices"]["method"].get<std::string>(),
                     made["cells"]["method"].get<std::string>()};
    order.name = order.methods.vertices;
    if (order.methods.elements != "lexmax") order.name += "/" + order.methods.elements;
  }

  static std::string own_program() {
    std::error_code code;
    const fs::path program = fs::read_symlink("/proc/self/exe", code);
    if (code) throw Unavailable("try: the system does not say where meshorder is (/proc/self/exe)");
    return program.string();
  }

  const TryArguments& arguments_;
  Progress& progress_;
  Readings readings_;
  std::string program_;
  TrialFolder folder_;
  TrialReport report_;
  Notes notes_;
  std::vector<std::string> are_own_;  ///< orders that keep everything where it is
  std::vector<double> last_seconds_;  ///< of each order's last run, by the clock
};

/// Throws unless the arguments make sense; before anything runs.
void check(const TryArguments& arguments) {
  if (arguments.command.empty()) {
    throw InvalidArgument(
        "there is no program to try: write it after --, as in meshorder try mesh.msh -- solver {}");
  }
  if (std::none_of(arguments.command.begin() + 1, arguments.command.end(), [](const std::string& word) {
        return word.find("{}") != std::string::npos || word.find("{stem}") != std::string::npos;
      })) {
    throw InvalidArgument(
        "the command has no {}, which stands for the mesh: write it where the program takes it");
  }
  (void)format_of(arguments.input);
  (void)output_format_of(arguments.input);
  if (!fs::is_regular_file(arguments.input))
    throw InputError(arguments.input, "there is no such file", "give the file of a mesh");
  if (without_gz(arguments.input) != arguments.input)
    throw InputError(arguments.input, "it is compressed, and orders of it would not be", "gunzip it first");
  for (const std::string& name : arguments.methods) {
    if (name != "auto") check_order(name);
  }
  if (!arguments.keep.empty() && fs::exists(arguments.keep) && !fs::is_empty(arguments.keep))
    throw InputError(arguments.keep, "it is there already", "name a folder that is new or empty");
}

void run(const TryArguments& arguments) {
  Console console(arguments);
  check(arguments);
  const TrialSignals signals;
  Progress progress(!console.quiet());
  Trial trial(arguments, progress);
  trial.run();
  progress.finish();
  console.warn_of(trial.notes());
  print_trial(console, trial.report());
  if (!arguments.keep.empty()) console.print("\nkept {}", arguments.keep);
  console.print_json(to_json(trial.report()));
}

/// Returns the options of the command line that `order` takes as well.
std::vector<std::string> passed_on(const CLI::App& subcommand) {
  std::vector<std::string> words;
  const auto add = [&](const CLI::Option* option) {
    for (const std::string& value : option->results()) {
      words.push_back("--" + option->get_lnames().front());
      if (option->get_items_expected_max() > 0) words.push_back(value);
    }
  };
  for (const char* const name : kPassedOn) add(subcommand.get_option(name));
  add(subcommand.get_parent()->get_option("--plugin"));
  return words;
}

/// The words after `--`.
std::vector<std::string>& program_to_try() {
  static std::vector<std::string> words;
  return words;
}

}  // namespace

void take_program_to_try(std::vector<std::string>& arguments) {
  const auto mark = std::find(arguments.begin(), arguments.end(), "--");
  if (mark == arguments.end() || std::find(arguments.begin(), mark, "try") == mark) return;
  program_to_try().assign(mark + 1, arguments.end());
  arguments.erase(mark, arguments.end());
}

void add_try(CLI::App& subcommand) {
  subcommand.description(
      "Run a program of yours on a mesh as it is and in other orders, and say in which it runs faster.\n"
      "The program comes after --. Of its words, {} stands for the mesh, {stem} for its name without\n"
      "extension, and {out} for a path for outputs. It runs without a shell, in a private folder with\n"
      "copies of the files beside the mesh; nothing of yours is changed.");
  subcommand.footer(
      "Examples:\n"
      "  meshorder try wing.su2 -- SU2_CFD wing.cfg {}\n"
      "  meshorder try beam.inp --same 'energy = (\\S+)' -- ccx {stem}\n"
      "  meshorder try part.msh --methods auto,rcm --time 'solve: (.*) s' -- ./solver --mesh={} --out={out}");
  const auto arguments = std::make_shared<TryArguments>();
  subcommand.add_option("MESH", arguments->input, "Mesh file, of a format that can be written")->required();
  subcommand
      .add_option("--methods", arguments->methods,
                  "Orders to try, VERTICES or VERTICES/ELEMENTS, separated by commas (default:\n" +
                      join(kDefaultOrders, std::string_view(",")) + ")")
      ->delimiter(',')
      ->allow_extra_args(false);
  subcommand
      .add_option("--budget", arguments->budget_seconds,
                  "Seconds for all runs of the program; orders that it does not suffice for are left out")
      ->check(positive())
      ->capture_default_str();
  subcommand
      .add_option("--timeout", arguments->timeout_seconds, "Seconds after which a run counts as failed")
      ->check(positive())
      ->capture_default_str();
  subcommand
      .add_option(
          "--time", arguments->time,
          "What counts: `cpu`, the processor time of the program and all that it starts; `wall`, the\n"
          "time by the clock; or a regular expression whose group is the last number in what the\n"
          "program prints that it captures")
      ->type_name("TIME")
      ->capture_default_str();
  subcommand
      .add_option("--count", arguments->count,
                  "Regular expression for a number that is shown for each order, such as iterations")
      ->type_name("REGEX");
  subcommand
      .add_option("--same", arguments->same,
                  "Regular expression for numbers that the program prints: an order is out of the trial\n"
                  "where they are not those of the first run")
      ->type_name("REGEX");
  subcommand
      .add_option(
          "--same-file", arguments->same_file,
          "The same for a file that the program writes, word by word; {out} or a path in its folder.\n"
          "Only for files in which the order of the mesh does not show")
      ->type_name("FILE");
  subcommand
      .add_option("--tolerance", arguments->tolerance, "Relative difference up to which numbers are the same")
      ->check(positive())
      ->capture_default_str();
  subcommand
      .add_option(
          "--with", arguments->with,
          "Names of the files and folders beside the mesh that the program needs, separated by commas\n"
          "(default: all that are not hidden)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAMES");
  subcommand
      .add_option("--keep", arguments->keep,
                  "New folder for the mesh and the outputs of the first run in each order")
      ->type_name("FOLDER");
  add_ids_option(subcommand, arguments->ids);
  add_workload_option(subcommand, arguments->ordering);
  add_seed_option(subcommand, arguments->ordering.seed);
  add_reading_options(subcommand);
  add_common(subcommand, *arguments);
  subcommand.callback([arguments, &subcommand] {
    arguments->command = program_to_try();
    arguments->to_order = passed_on(subcommand);
    run(*arguments);
  });
}

}  // namespace meshorder::command
