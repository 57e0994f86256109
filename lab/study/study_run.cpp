// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/study_run.hpp"

#include "base/text.hpp"
#include "io/format.hpp"
#include "io/stream/output_set.hpp"
#include "io/stream/scratch.hpp"
#include "lab/models/catalogue.hpp"
#include "lab/scenario/motion_metrics.hpp"
#include "lab/scenario/scenario_obstacles.hpp"
#include "lab/scenario/simulation.hpp"
#include "lab/study/study_store.hpp"
#include "lab/study/study_turns.hpp"
#include "lab/support/json.hpp"
#include "payoff/machine.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace meshorder {
namespace {
namespace fs = std::filesystem;

/// A scenario of the plan, with its mesh and the turns of its runs.
struct Subject {
  std::string argument;  ///< as the plan names it
  Scenario scenario;
  std::string mesh;  ///< MeshRecord::name
  std::string mesh_path;
  StepperReady body;
  TurnPlan turns;
};

/// A part of a study's time, by its begin and end as shares of the whole.
struct Share {
  double from = 0, to = 1;

  [[nodiscard]] Share part(double first, double last) const {
    return {from + first * (to - from), from + last * (to - from)};
  }
};

/// Share of a study's time for the meshes' orders and kernels; the runs take the rest.
constexpr double kMeshShare = 0.1;

class Study {
 public:
  Study(const StudyPlan& plan, const StudyFolder& folder, fs::path program, const StudyObserver& observer)
      : plan_(plan), store_(plan, folder), program_(std::move(program)), observer_(observer) {
    if (plan.pin) processors_ = choose_processors(plan.threads);
    if (plan.pin && processors_.empty())
      observer.note("the threads are not bound to processors: the system does not report them");
  }

  bool run() {
    for (const std::string& argument : plan_.scenarios) choose(argument);
    const auto count = static_cast<double>(subjects_.size());
    for (std::size_t i = 0; i < subjects_.size(); ++i) {
      const auto number = static_cast<double>(i);
      prepare(subjects_[i], Share{0, kMeshShare}.part(number / count, (number + 1) / count));
      if (observer_.stop()) return false;
    }
    double all = 0;
    for (const Subject& subject : subjects_) all += remaining_seconds(subject);
    double done = 0;
    for (const Subject& subject : subjects_) {
      const double seconds = remaining_seconds(subject);
      if (seconds > 0 && !run_all(subject, Share{kMeshShare, 1}.part(done / all, (done + seconds) / all)))
        return false;
      done += seconds;
    }
    return true;
  }

 private:
  void stage(const std::string& what, const Share& share) const {
    observer_.stage(what, share.from, share.to);
  }

  void choose(const std::string& argument) {
    Subject subject;
    subject.argument = argument;
    subject.scenario = find_scenario(argument);
    if (subject.scenario.is_fluid()) return choose_fluid(std::move(subject));
    std::string& mesh = subject.scenario.mesh;
    mesh = plan_.mesh.empty() ? mesh_of_size(plan_.size, mesh) : plan_.mesh;
    if (!plan_.mesh.empty()) subject.scenario.mesh_folder.reset();
    if (!fits_in_memory(plan_.size, subject.scenario)) {
      observer_.note(fmt::format("{} is skipped: its factored matrix would not fit in memory at size {}",
                                 subject.scenario.name, plan_.size));
      return;
    }
    subject.mesh = names_a_model(mesh) ? mesh : visible(fs::path(mesh).stem().string());
    if (subject.mesh.size() > kLongestNameInFiles)
      throw InputError(mesh, "its name is too long to become part of file names",
                       fmt::format("give it one of at most {} bytes", kLongestNameInFiles));
    add(std::move(subject));
  }

  /// Adds a fluid. Its mesh at the start is studied under the scenario's name.
  void choose_fluid(Subject subject) {
    if (!plan_.mesh.empty())
      throw InvalidArgument(subject.scenario.name + " makes its own mesh: leave out --mesh, or the scenario");
    subject.scenario.fluid().spacing = spacing_of_size(plan_.size, subject.scenario.fluid());
    subject.mesh = subject.scenario.name;
    add(std::move(subject));
  }

  void add(Subject subject) {
    for (const Subject& other : subjects_) {
      if (other.scenario.name == subject.scenario.name)
        throw InvalidArgument("two scenarios have the name " + other.scenario.name);
      if (other.mesh == subject.mesh && other.scenario.mesh != subject.scenario.mesh)
        throw InvalidArgument("two meshes have the name " + subject.mesh);
    }
    subjects_.push_back(std::move(subject));
  }

  /// Makes the mesh and its orders and runs the first step, so that errors appear before the long runs.
  void prepare(Subject& subject, const Share& share) {
    subject.mesh_path = subject.scenario.mesh;
    if (!subject.scenario.is_fluid() && names_a_model(subject.mesh_path)) {
      MakeOptions options;
      options.progress = [&](std::string_view step, double) {
        stage("model " + subject.mesh + ": " + std::string(step), share);
      };
      subject.mesh_path = make_model(subject.scenario.mesh, options).path.string();
    }
    if (!store_.has_mesh(subject.mesh)) study_mesh_of(subject, share.part(0, 0.8));
    stage(subject.scenario.name + ": the first step", share.part(0.8, 1));
    const Stepper rehearsal(program_, plan_.threads, task_of(subject, plan_.orderings.front()));
    subject.body = rehearsal.ready();
    subject.turns = plan_turns(subject.body, plan_.steps.value_or(subject.scenario.steps),
                               plan_.scenario_seconds, static_cast<int>(plan_.orderings.size()));
    if (const ScenarioRecord* const begun = store_.find(subject.scenario.name)) go_on_with(*begun, subject);
  }

  /// Sets the turns to those of the first run. Throws Error if `begun` is of another simulation.
  void go_on_with(const ScenarioRecord& begun, Subject& subject) const {
    const bool may_have_other_steps = plan_.scenario_seconds && !plan_.steps;
    if (begun.fingerprint != subject.body.fingerprint ||
        (begun.steps != subject.turns.steps && !may_have_other_steps))
      throw InputError(store_.folder().results().string(), "holds another " + subject.scenario.name,
                       "give a new folder, or the scenario, mesh and steps as they were");
    subject.turns.steps = begun.steps;
    subject.turns.turn = begun.turn;
    subject.turns.interleaved = begun.interleaved;
  }

  void study_mesh_of(const Subject& subject, const Share& share) {
    Mesh mesh = subject.scenario.is_fluid() ? mesh_at_start(subject.scenario)
                                            : read_mesh_from(subject.scenario.mesh_file(subject.mesh_path));
    require_volume_cells(mesh, subject.mesh_path);
    mesh.cell_blocks.clear();  // blocks are a file's layout and would restrict the cells' order
    MeshStudyOptions options;
    options.ordering = plan_.ordering;
    options.threads = plan_.threads;
    options.timing.budget_seconds = plan_.kernel_seconds;
    options.progress = [&](std::string_view what, double fraction) {
      stage(subject.mesh + ": " + std::string(what), share.part(fraction, 1));
    };
    OrderedMesh studied = study_mesh(mesh, plan_.orderings, options);
    studied.record.name = subject.mesh;
    store_.keep(mesh, std::move(studied));
  }

  [[nodiscard]] StepperTask task_of(const Subject& subject, const OrderingSpec& ordering) const {
    if (subject.scenario.is_fluid())
      return {.scenario = subject.argument,
              .processors = processors_,
              .vertex_method = ordering.vertices,
              .element_method = ordering.elements,
              .spacing = subject.scenario.fluid().spacing};
    return {subject.argument, subject.mesh_path,
            store_.folder().vertex_order(subject.mesh, ordering.name).string(),
            store_.folder().cell_order(subject.mesh, ordering.name).string(), processors_};
  }

  [[nodiscard]] double remaining_seconds(const Subject& subject) const {
    return std::max(0, plan_.runs - store_.runs_done(subject.scenario.name)) * subject.turns.steps *
           subject.body.step_seconds * static_cast<double>(plan_.orderings.size());
  }

  /// Makes the missing runs of a scenario. Returns false if stopped.
  bool run_all(const Subject& subject, const Share& share) {
    const int first = store_.runs_done(subject.scenario.name);
    const double count = plan_.runs - first;
    for (int run = first; run < plan_.runs; ++run) {
      if (!run_once(subject, run, share.part((run - first) / count, (run + 1 - first) / count))) return false;
    }
    return true;
  }

  bool run_once(const Subject& subject, int run, const Share& share) {
    Round round{program_, plan_.threads, {}, {}, {}, subject.turns, run};
    std::vector<Scratch> motions;
    for (const OrderingSpec& ordering : plan_.orderings) {
      round.tasks.push_back(task_of(subject, ordering));
      if (run > 0) continue;
      motions.emplace_back(store_.folder().motion(subject.scenario.name));
      round.motions.push_back(motions.back().file().string());
    }
    std::optional<Scratch> surfaces;
    if (run == 0 && subject.scenario.is_fluid())
      round.surfaces = surfaces.emplace(store_.folder().surfaces(subject.scenario.name)).file().string();
    const std::string what = fmt::format("{}, run {} of {}", subject.scenario.name, run + 1, plan_.runs);
    stage(what, share);
    const auto runs = run_round(round, subject.body.fingerprint, [&](double done) {
      stage(what, share.part(done, 1));
      return !observer_.stop();
    });
    if (!runs) return false;
    if (surfaces) {
      const FinishedFile kept{surfaces->path(),
                              store_.folder().file(store_.folder().surfaces(subject.scenario.name))};
      put_in_place({&kept, 1});
    }
    if (run == 0) store_.begin(record_of(subject, motions));
    store_.keep(subject.scenario.name, *runs);
    return true;
  }

  /// Returns the record of a scenario after its first run, with motion differences but without runs.
  [[nodiscard]] ScenarioRecord record_of(const Subject& subject, const std::vector<Scratch>& motions) const {
    ScenarioRecord record = store_.new_record(subject.scenario);
    record.mesh = subject.mesh;
    record.fingerprint = subject.body.fingerprint;
    record.steps = subject.turns.steps;
    record.turn = subject.turns.turn;
    record.interleaved = subject.turns.interleaved;
    record.processors = processors_;
    record.fixed_addresses = subject.body.fixed_addresses;
    for (Index step = 0; step <= subject.turns.steps; step += subject.turns.frame_every)
      record.frame_steps.push_back(step);
    compare_motions(subject, motions, record);
    return record;
  }

  /// Compares the motions with that of the first order; keeps that motion and the obstacles for the page.
  void compare_motions(const Subject& subject, const std::vector<Scratch>& motions,
                       ScenarioRecord& record) const {
    const StudyFolder& folder = store_.folder();
    const Motion reference = read_motion(motions.front().file());
    for (std::size_t i = 0; i < motions.size(); ++i)
      record.orders[i].motion =
          difference_of(read_motion(motions[i].file()), reference, subject.body.longest_side);
    const FinishedFile kept{motions.front().path(), folder.file(folder.motion(subject.scenario.name))};
    put_in_place({&kept, 1});
    if (!subject.scenario.is_projective() || subject.scenario.projective().obstacles.empty()) return;
    write_mesh_to(surfaces_of(subject.scenario.projective().obstacles, subject.body.longest_side),
                  folder.file(folder.obstacles(subject.scenario.name)), {});
  }

  const StudyPlan& plan_;
  StudyStore store_;
  fs::path program_;
  const StudyObserver& observer_;
  std::vector<int> processors_;
  std::vector<Subject> subjects_;
};

}  // namespace

bool run_study(const StudyPlan& plan, const StudyFolder& folder, const fs::path& program,
               const StudyObserver& observer) {
  return Study(plan, folder, program, observer).run();
}

}  // namespace meshorder
