// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/io/format.hpp>
#include <meshorder/io/npy.hpp>
#include <meshorder/models/catalogue.hpp>
#include <meshorder/study/machine.hpp>
#include <meshorder/study/mesh_study.hpp>
#include <meshorder/study/motion_difference.hpp>
#include <meshorder/study/obstacles.hpp>
#include <meshorder/study/processors.hpp>
#include <meshorder/study/results_json.hpp>
#include <meshorder/study/scenario.hpp>
#include <meshorder/study/simulation.hpp>
#include <meshorder/study/statistics.hpp>
#include <meshorder/study/study_run.hpp>
#include <meshorder/study/study_turns.hpp>
#include <meshorder/study/timestamp.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

namespace meshorder {
namespace {
namespace fs = std::filesystem;

/// A scenario of the plan and what is known of it before it is run.
struct Subject {
  std::string argument;  ///< as the plan names it
  Scenario scenario;
  std::string mesh;  ///< MeshRecord::name
  std::string mesh_path;
  StepperReady body;
  TurnPlan turns;
};

std::string stem_of(const std::string& mesh) {
  return names_a_model(mesh) ? mesh : fs::path(mesh).stem().string();
}

/// Shares of a study's time: the meshes' orders and kernels, then the runs.
constexpr double kMeshShare = 0.1;

class Study {
 public:
  Study(const StudyPlan& plan, const StudyFolder& folder, fs::path program, const StudyObserver& observer)
      : plan_(plan), folder_(folder), program_(std::move(program)), observer_(observer) {
    make_folders();
    begin_or_resume();
    if (plan.pin) processors_ = choose_processors(plan.threads);
    if (plan.pin && processors_.empty())
      observer.note("the threads are not bound: the system does not tell its processors");
  }

  bool run() {
    for (const std::string& argument : plan_.scenarios) choose(argument);
    for (std::size_t i = 0; i < subjects_.size(); ++i) {
      const auto n = static_cast<double>(subjects_.size());
      prepare(subjects_[i], kMeshShare * static_cast<double>(i) / n,
              kMeshShare * static_cast<double>(i + 1) / n);
      if (observer_.stop()) return false;
    }
    double all = 0;
    for (const Subject& subject : subjects_) all += remaining_seconds(subject);
    double done = 0;
    for (const Subject& subject : subjects_) {
      const double share = remaining_seconds(subject);
      const auto at = [&](double seconds) {
        return kMeshShare + (1 - kMeshShare) * seconds / std::max(all, 1e-9);
      };
      if (!run_scenario(subject, at(done), at(done + share))) return false;
      done += share;
    }
    return true;
  }

 private:
  void make_folders() const {
    std::error_code code;
    fs::create_directories(folder_.data(), code);
    if (code)
      throw Error(folder_.root().string(), "cannot be made: " + code.message(),
                  "name a folder for the results");
  }

  void begin_or_resume() {
    std::error_code code;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_.data())) {
      // what an interrupted study left unfinished
      if (entry.path().filename().string().front() == '.') fs::remove(entry.path(), code);
    }
    MachineRecord machine = describe_machine();
    if (!fs::exists(folder_.results(), code)) {
      results_.began = timestamp_now();
      results_.size = plan_.size;
      results_.runs = plan_.runs;
      results_.threads = plan_.threads;
      results_.reference = plan_.reference;
      results_.orderings = plan_.orderings;
      results_.machine = std::move(machine);
      return;
    }
    results_ = read_results(folder_.results());
    const auto same = [&](bool is_same, const std::string& what) {
      if (!is_same)
        throw Error(folder_.results().string(), "is of a study with " + what,
                    "give a new folder, or the same options as before");
    };
    same(results_.machine.processor == machine.processor, "another processor: " + results_.machine.processor);
    same(results_.machine.program == machine.program && results_.machine.compiler == machine.compiler &&
             results_.machine.flags == machine.flags,
         "another build of meshorder");
    same(results_.size == plan_.size, "meshes of size " + results_.size);
    same(results_.threads == plan_.threads, fmt::format("{} threads", results_.threads));
    same(results_.reference == plan_.reference, "another reference: " + results_.reference);
    const bool same_orderings =
        std::equal(results_.orderings.begin(), results_.orderings.end(), plan_.orderings.begin(),
                   plan_.orderings.end(), [](const auto& a, const auto& b) { return a.name == b.name; });
    same(same_orderings, "other orderings");
    results_.runs = std::max(results_.runs, plan_.runs);
  }

  void choose(const std::string& argument) {
    Subject subject;
    subject.argument = argument;
    subject.scenario = find_scenario(argument);
    if (!can_be_had(plan_.size, subject.scenario)) {
      observer_.note(fmt::format("{} is left out: its factored matrix would not fit in memory at size {}",
                                 subject.scenario.name, plan_.size));
      return;
    }
    subject.scenario.mesh = plan_.mesh.empty() ? mesh_of_size(plan_.size, subject.scenario.mesh) : plan_.mesh;
    subject.mesh = stem_of(subject.scenario.mesh);
    subjects_.push_back(std::move(subject));
  }

  /// Makes the mesh and its orders, and takes the first step, so that what cannot be run is known before
  /// hours are spent on the rest.
  void prepare(Subject& subject, double from, double to) {
    const double middle = 0.5 * (from + to);
    observer_.stage("mesh " + subject.mesh, from, middle);
    subject.mesh_path = subject.scenario.mesh;
    if (names_a_model(subject.mesh_path)) {
      MakeOptions options;
      options.progress = [&](std::string_view step, double) {
        observer_.stage("model " + subject.mesh + ": " + std::string(step), from, middle);
      };
      subject.mesh_path = make_model(subject.scenario.mesh, options).path.string();
    }
    study_mesh_of(subject, from, middle);
    observer_.stage(subject.scenario.name + ": the first step", middle, to);
    const Stepper rehearsal(program_, plan_.threads, task_of(subject, plan_.orderings.front().name));
    subject.body = rehearsal.ready();
    subject.turns = plan_turns(subject.body, plan_.steps.value_or(subject.scenario.steps),
                               plan_.scenario_seconds, static_cast<int>(plan_.orderings.size()));
    if (const ScenarioRecord* const known = find(subject.scenario.name)) {
      if (known->fingerprint != subject.body.fingerprint ||
          (plan_.steps && known->steps != subject.turns.steps) ||
          (!plan_.scenario_seconds && known->steps != subject.turns.steps))
        throw Error(folder_.results().string(), "holds another " + subject.scenario.name,
                    "give a new folder, or the scenario, mesh and steps as they were");
      subject.turns.steps = known->steps;
      subject.turns.turn = known->turn;
      subject.turns.interleaved = known->interleaved;
    }
  }

  void study_mesh_of(const Subject& subject, double from, double to) {
    const auto known = std::find_if(results_.meshes.begin(), results_.meshes.end(),
                                    [&](const MeshRecord& m) { return m.name == subject.mesh; });
    if (known != results_.meshes.end()) return;
    Mesh mesh = read_mesh(subject.mesh_path);
    require_volume_cells(mesh, subject.mesh_path);
    mesh.cell_blocks.clear();  // what is compared is the orders, not a file's layout
    MeshStudyOptions options;
    options.ordering = plan_.ordering;
    options.threads = plan_.threads;
    options.timing.budget_seconds = plan_.kernel_seconds;
    options.progress = [&](std::string_view what, double fraction) {
      observer_.stage(subject.mesh + ": " + std::string(what), from + fraction * (to - from), to);
    };
    OrderedMesh studied = study_mesh(mesh, plan_.orderings, options);
    for (std::size_t i = 0; i < studied.orders.size(); ++i) {
      const std::string& ordering = plan_.orderings[i].name;
      write_npy(studied.orders[i].vertices.old_to_new(), folder_.vertex_order(subject.mesh, ordering));
      write_npy(studied.orders[i].cells.old_to_new(), folder_.cell_order(subject.mesh, ordering));
    }
    Mesh bare;
    bare.points = std::move(mesh.points);
    bare.cells = std::move(mesh.cells);
    write_mesh(bare, folder_.mesh(subject.mesh));
    studied.record.name = subject.mesh;
    studied.record.file = fs::relative(folder_.mesh(subject.mesh), folder_.root()).string();
    results_.meshes.push_back(std::move(studied.record));
    save();
  }

  [[nodiscard]] StepperTask task_of(const Subject& subject, const std::string& ordering) const {
    return {subject.argument, subject.mesh_path, folder_.vertex_order(subject.mesh, ordering).string(),
            folder_.cell_order(subject.mesh, ordering).string(), processors_};
  }

  ScenarioRecord* find(const std::string& name) {
    const auto found = std::find_if(results_.scenarios.begin(), results_.scenarios.end(),
                                    [&](const ScenarioRecord& s) { return s.name == name; });
    return found == results_.scenarios.end() ? nullptr : &*found;
  }

  [[nodiscard]] int runs_done(const std::string& name) {
    const ScenarioRecord* const record = find(name);
    return record == nullptr ? 0 : static_cast<int>(record->orders.front().runs.size());
  }

  [[nodiscard]] double remaining_seconds(const Subject& subject) {
    return std::max(0, plan_.runs - runs_done(subject.scenario.name)) * subject.turns.steps *
           subject.body.step_seconds * static_cast<double>(plan_.orderings.size());
  }

  bool run_scenario(const Subject& subject, double from, double to) {
    const int first = runs_done(subject.scenario.name);
    for (int run = first; run < plan_.runs; ++run) {
      const double share = (to - from) / (plan_.runs - first);
      const double begin = from + share * (run - first);
      Round round{program_, plan_.threads, {}, {}, subject.turns, run};
      for (const StudyOrdering& ordering : plan_.orderings) {
        round.tasks.push_back(task_of(subject, ordering.name));
        if (run == 0) round.motions.push_back(motion_in_work(subject, ordering.name));
      }
      const std::string what = fmt::format("{}, run {} of {}", subject.scenario.name, run + 1, plan_.runs);
      observer_.stage(what, begin, begin + share);
      const auto runs = run_round(round, subject.body.fingerprint, [&](double done) {
        observer_.stage(what, begin + share * done, begin + share);
        return !observer_.stop();
      });
      if (!runs) return false;
      keep(subject, *runs);
    }
    return true;
  }

  [[nodiscard]] std::string motion_in_work(const Subject& subject, const std::string& ordering) const {
    const fs::path motion = folder_.motion(subject.scenario.name);
    return (motion.parent_path() / ("." + ordering + "-" + motion.filename().string())).string();
  }

  void keep(const Subject& subject, const std::vector<RunRecord>& runs) {
    ScenarioRecord* record = find(subject.scenario.name);
    if (record == nullptr) {
      results_.scenarios.push_back(record_of(subject));
      record = &results_.scenarios.back();
      compare_motions(subject, *record);
      sort_scenarios();
      record = find(subject.scenario.name);
    }
    for (std::size_t i = 0; i < runs.size(); ++i) record->orders[i].runs.push_back(runs[i]);
    summarise(results_);
    save();
  }

  /// In the paper's order, whichever was run first; others behind.
  void sort_scenarios() {
    const auto place = [](const ScenarioRecord& record) {
      const auto known = built_in_scenarios();
      return std::find_if(known.begin(), known.end(),
                          [&](const BuiltInScenario& b) { return b.name == record.name; }) -
             known.begin();
    };
    std::stable_sort(results_.scenarios.begin(), results_.scenarios.end(),
                     [&](const ScenarioRecord& a, const ScenarioRecord& b) { return place(a) < place(b); });
  }

  [[nodiscard]] ScenarioRecord record_of(const Subject& subject) const {
    const Scenario& scenario = subject.scenario;
    ScenarioRecord record;
    record.name = scenario.name;
    record.title = scenario.title;
    record.method = scenario.is_implicit() ? "backward-euler" : "admm";
    record.material = scenario.is_implicit() ? name_in(kMaterialModels, scenario.model)
                                             : name_in(kLocalModels, scenario.projective().model);
    record.mesh = subject.mesh;
    record.fingerprint = subject.body.fingerprint;
    record.steps = subject.turns.steps;
    record.turn = subject.turns.turn;
    record.interleaved = subject.turns.interleaved;
    record.processors = processors_;
    record.fixed_addresses = subject.body.fixed_addresses;
    for (Index step = 0; step <= subject.turns.steps; step += subject.turns.frame_every)
      record.frame_steps.push_back(step);
    for (const StudyOrdering& ordering : plan_.orderings)
      record.orders.push_back({ordering.name, {}, {}, {}, {}});
    return record;
  }

  /// Of the first run's motions the first order's is kept, for the page.
  void compare_motions(const Subject& subject, ScenarioRecord& record) const {
    const std::string kept = motion_in_work(subject, plan_.orderings.front().name);
    const Motion reference = read_motion(kept);
    for (OrderOfScenario& order : record.orders) {
      const std::string file = motion_in_work(subject, order.ordering);
      if (file == kept) {
        order.motion.by_frame.assign(reference.frames.size(), 0.0);
        continue;
      }
      order.motion = difference_of(read_motion(file), reference, subject.body.longest_side);
      fs::remove(file);
    }
    fs::rename(kept, folder_.motion(subject.scenario.name));
    if (subject.scenario.is_implicit() || subject.scenario.projective().obstacles.empty()) return;
    write_mesh(surfaces_of(subject.scenario.projective().obstacles, subject.body.longest_side),
               folder_.obstacles(subject.scenario.name));
  }

  void save() const { write_results(results_, folder_.results()); }

  const StudyPlan& plan_;
  const StudyFolder& folder_;
  fs::path program_;
  const StudyObserver& observer_;
  std::vector<int> processors_;
  std::vector<Subject> subjects_;
  StudyResults results_;
};

}  // namespace

bool run_study(const StudyPlan& plan, const StudyFolder& folder, const fs::path& program,
               const StudyObserver& observer) {
  return Study(plan, folder, program, observer).run();
}

}  // namespace meshorder
