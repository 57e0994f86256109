// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/calibration.hpp"

#include "base/host.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "mesh/graphs.hpp"
#include "payoff/calibration_lattices.hpp"
#include "payoff/calibration_store.hpp"
#include "payoff/machine.hpp"
#include "payoff/machine_choice.hpp"
#include "support/files.hpp"
#include <meshorder/error.hpp>
#include <meshorder/payoff.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

using testing::HasSubstr;

/// Sets an environment variable for the lifetime of the object.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* const before = std::getenv(name)) before_ = before;
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() {
    if (before_.empty()) {
      ::unsetenv(name_);
    } else {
      ::setenv(name_, before_.c_str(), 1);
    }
  }
  Variable(const Variable&) = delete;
  Variable(Variable&&) = delete;
  Variable& operator=(const Variable&) = delete;
  Variable& operator=(Variable&&) = delete;

 private:
  const char* name_;
  std::string before_;
};

/// A calibration of this machine and build, with a different number in each member.
Calibration made_up() {
  Calibration calibration;
  calibration.model.machine = "a machine";
  calibration.model.caches = parse_cache_sizes("48K,1M,20M");
  double number = 0.25;
  const auto next = [&] { return number += 0.125; };
  calibration.all_threads.machine = calibration.model.machine;
  calibration.all_threads.caches = calibration.model.caches;
  calibration.all_threads.threads = calibration.threads = 7;
  for (auto* const kernels : {&calibration.model.solid, &calibration.model.flat,
                              &calibration.all_threads.solid, &calibration.all_threads.flat}) {
    for (KernelCosts& costs : *kernels) {
      CostRow row;
      for (double& cost : row) cost = next();
      costs = as_costs(row);
    }
  }
  calibration.processor = processor_of_this_machine();
  calibration.build = build_of_this_program();
  calibration.reported = reported_caches();
  calibration.date = "2026-01-02";
  calibration.found = {{{48 << 10, next()}, {21 << 20, next()}}, next()};
  calibration.read_bandwidth = next();
  calibration.read_bandwidth_all = next();
  for (FitQuality* const quality : {&calibration.quality, &calibration.all_threads_quality}) {
    for (auto* const array : {&quality->condition, &quality->error, &quality->floor}) {
      for (double& value : *array) value = next() / 100;
    }
  }
  calibration.steadiness = {0.01, 0.02, 0.03};
  calibration.seconds = next();
  return calibration;
}

/// Runs whose times follow from the costs, without jumps farther than `farthest` lines.
std::vector<TimedReuse> runs_that_cost(const KernelCosts& costs, const Caches& caches, Index farthest) {
  CostModel model;
  model.solid[0] = costs;
  Random random(2);
  std::vector<TimedReuse> runs;
  for (int i = 0; i < 20; ++i) {
    TimedReuse run;
    run.reuse.dimension = 3;
    for (const Index distance : {100, 1000, 30'000, 200'000, 300'000}) {
      const auto count = 10'000 + random.below(100'000);
      for (std::uint64_t j = 0; j < count; ++j) {
        run.reuse.all.add(distance);
        if (distance <= farthest && random.unit() < 0.1 * (i % 7)) run.reuse.jumps.add(distance);
      }
    }
    run.lattice = i / 5;
    run.milliseconds = predicted_ms(run.reuse, caches, model);
    runs.push_back(std::move(run));
  }
  return runs;
}

TEST(Calibration, CostsThatMadeTheTimesAreFound) {
  const Caches caches = parse_cache_sizes("32K,1M,16M");
  const Latencies latencies{3, 20, 60, 40};
  // jumps that cost a seventh of their latencies, as costs are expected to
  const KernelCosts costs{
      .access = 0.5, .miss = {0.25, 0, 1, 2}, .jump = {3.0 / 7, 20.0 / 7, 60.0 / 7, 40.0 / 7}};
  const FittedCosts fitted = fit_costs(runs_that_cost(costs, caches, 300'000), caches, latencies);
  const CostRow found = as_row(fitted.costs);
  const CostRow expected = as_row(costs);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-6) << i;
  EXPECT_LT(fitted.error, 1e-9);
  EXPECT_GT(fitted.condition, 1);
  EXPECT_LT(fitted.condition, 1e4);
}

TEST(Calibration, WhatAllRunsOfALatticeAreOffByMattersLess) {
  const Caches caches = parse_cache_sizes("32K,1M,16M");
  const Latencies latencies{3, 20, 60, 40};
  const KernelCosts costs{.access = 0.5, .miss = {0.25, 0, 1, 2}, .jump = {0.3, 2, 6, 4}};
  std::vector<TimedReuse> runs = runs_that_cost(costs, caches, 300'000);
  // memory is slower while two of the lattices are timed
  for (TimedReuse& run : runs) run.milliseconds *= run.lattice % 2 == 0 ? 1 : 1.3;
  CostModel model;
  const auto ratios_off = [&](std::span<const TimedReuse> fitted) {
    model.solid[0] = fit_costs(fitted, caches, latencies).costs;
    double off = 0;
    for (std::size_t i = 1; i < runs.size(); ++i) {
      if (runs[i].lattice != runs[i - 1].lattice) continue;
      const double ratio =
          predicted_ms(runs[i].reuse, caches, model) / predicted_ms(runs[i - 1].reuse, caches, model);
      off += std::abs(std::log(ratio * runs[i - 1].milliseconds / runs[i].milliseconds));
    }
    return off;
  };
  std::vector<TimedReuse> apart = runs;
  for (std::size_t i = 0; i < apart.size(); ++i) apart[i].lattice = static_cast<int>(i);
  EXPECT_LT(ratios_off(runs), 0.7 * ratios_off(apart));
}

TEST(Calibration, RunsOutvoteWhatJumpsAreExpectedToCost) {
  const Caches caches = parse_cache_sizes("32K,1M,16M");
  const KernelCosts costs{.access = 0.5, .miss = {0.25, 0, 1, 2}, .jump = {0, 3, 0, 20}};
  const FittedCosts fitted = fit_costs(runs_that_cost(costs, caches, 300'000), caches, {3, 20, 60, 40});
  EXPECT_LT(fitted.error, 0.01);
  EXPECT_NEAR(fitted.costs.jump[1], 3, 0.5);
  EXPECT_LT(fitted.costs.jump[2], fitted.costs.jump[3]);
}

TEST(Calibration, JumpsThatNoRunHasCostTheShareOfTheirLatencyThatOthersDo) {
  const Caches caches = parse_cache_sizes("32K,1M,16M");
  const KernelCosts costs{.access = 0.5, .miss = {0.25, 0, 1, 2}, .jump = {0.3, 2, 7, 9}};
  // 30,000 lines lie between 1 MB and 8 MB
  const FittedCosts fitted = fit_costs(runs_that_cost(costs, caches, 30'000), caches, {3, 20, 60, 40});
  EXPECT_NEAR(fitted.costs.jump[0], 0.3, 1e-6);
  EXPECT_NEAR(fitted.costs.jump[1], 2, 1e-6);
  EXPECT_NEAR(fitted.costs.jump[2], 6, 1e-5);
  EXPECT_NEAR(fitted.costs.jump[3], 4, 1e-5);
  EXPECT_LT(fitted.error, 1e-9);
}

TEST(Calibration, WhatRunsDoNotTellIsTakenFromKnownCostsTimesOneFactor) {
  const Caches caches = parse_cache_sizes("32K,1M,16M");
  const Latencies latencies{3, 20, 60, 40};
  const KernelCosts known{
      .access = 0.5, .miss = {0.25, 0, 1, 2}, .jump = {3.0 / 7, 20.0 / 7, 60.0 / 7, 40.0 / 7}};
  CostRow faster = as_row(known);
  for (double& cost : faster) cost *= 0.6;
  CostModel model;
  model.solid[0] = as_costs(faster);
  std::vector<TimedReuse> runs = runs_that_cost(known, caches, 300'000);
  // no run has jumps of the second cache and beyond
  for (TimedReuse& run : runs) {
    run.reuse.jumps = {};
    run.milliseconds = predicted_ms(run.reuse, caches, model);
  }
  const CostRow found = as_row(fit_costs(runs, caches, latencies, &known).costs);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], faster[i], 1e-6) << i;
  EXPECT_LT(fit_costs(runs, caches, latencies).costs.jump[3], 0.5 * found[8]);
}

TEST(Calibration, RunsMoveCostsAwayFromKnownOnes) {
  const Caches caches = parse_cache_sizes("32K,1M,16M");
  const KernelCosts costs{.access = 0.5, .miss = {0.25, 0, 1, 2}, .jump = {0.3, 2, 6, 4}};
  KernelCosts known = costs;
  known.miss[1] = 2;
  const std::vector<TimedReuse> runs = runs_that_cost(costs, caches, 300'000);
  const FittedCosts fitted = fit_costs(runs, caches, {3, 20, 60, 40}, &known);
  EXPECT_LT(fitted.error, 0.5 * scale_costs(runs, known, caches).error);
  EXPECT_LT(fitted.costs.miss[1], 1.2);
}

TEST(Calibration, LatenciesBeyondSizesAreThoseOfTheNextLevels) {
  const FoundCaches found{.levels = {{30 << 10, 1.0}, {1100 << 10, 4.0}, {16 << 20, 24.0}},
                          .memory_nanoseconds = 124};
  EXPECT_EQ(latencies_beyond(found, parse_cache_sizes("32K,1M,16M")), (Latencies{3, 20, 50, 50}));
  // the level of 1 MB is found, but is no cache of the cost model
  EXPECT_EQ(latencies_beyond(found, parse_cache_sizes("32K,16M")), (Latencies{3, 120, 1, 1}));
  EXPECT_EQ(
      latencies_beyond({.levels = {{32 << 10, 2.0}}, .memory_nanoseconds = 2.5}, parse_cache_sizes("32K")),
      (Latencies{1, 1, 1, 1}));
}

TEST(Calibration, OneFactorIsFoundForAllCosts) {
  const Caches caches = parse_cache_sizes("32K,1M,16M");
  const CostModel& model = zen3_costs();
  std::vector<TimedReuse> runs;
  for (const Index vertices : {1000, 4000, 20'000}) {
    const CalibrationLattice lattice = make_calibration_lattice(vertices, false, caches, 3);
    const Mesh mesh = in_order(lattice, lattice.orders.back());
    const RunReuse reuse = reuse_of_kernels(vertex_graph(mesh), cut_into_simplices(mesh), 0)[0];
    // errors of a tenth in both directions: the factor is Σ r / Σ r², where r is predicted over measured time
    const double error = vertices == 1000 ? 1.1 : vertices == 4000 ? 1 / 1.1 : 1;
    runs.push_back({reuse, 0.6 * error * predicted_ms(reuse, caches, model)});
  }
  const double r = 1 / 1.1 + 1.1 + 1;
  const double factor = 0.6 * r / (1 / 1.21 + 1.21 + 1);
  const FittedCosts fitted = scale_costs(runs, model.solid[0], caches);
  const CostRow found = as_row(fitted.costs);
  const CostRow before = as_row(model.solid[0]);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], factor * before[i], 1e-12) << i;
  EXPECT_EQ(fitted.condition, 1);
  EXPECT_NEAR(fitted.error, 0.094, 0.01);
}

TEST(Calibration, LatticesAreScrambledWithinWindowsOnly) {
  const Caches caches = parse_cache_sizes("32K,1M,16M");
  const CalibrationLattice lattice = make_calibration_lattice(5000, false, caches, 8);
  EXPECT_NEAR(lattice.mesh.vertex_count(), 5000, 700);
  EXPECT_EQ(lattice.orders.front(), (LatticeOrder{}));
  EXPECT_EQ(lattice.orders.back(), (LatticeOrder{lattice.mesh.vertex_count(), LatticeElements::shuffled}));
  ASSERT_GE(lattice.orders.size(), 5U);
  EXPECT_LE(lattice.orders.size(), 9U);
  std::map<Point, Index> places;
  for (Index v = 0; v < lattice.mesh.vertex_count(); ++v) places[lattice.mesh.points[v]] = v;
  EXPECT_EQ(lattice.orders[1], (LatticeOrder{0}));
  for (const LatticeOrder& order : lattice.orders) {
    if (order.window == 0) continue;
    const Mesh mesh = in_order(lattice, order);
    Index moved = 0;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const Index before = places.at(mesh.points[v]);
      EXPECT_EQ(before / order.window, v / order.window);
      moved += before != v ? 1 : 0;
    }
    if (order.window > 1) {
      EXPECT_GT(moved, mesh.vertex_count() / 2);
    }
    EXPECT_EQ(vertex_graph(mesh).edge_count(), lattice.graph.edge_count());
  }
}

TEST(Calibration, BreadthFirstLoopsEndWhereTheyDidBefore) {
  const CalibrationLattice lattice =
      make_calibration_lattice(5000, false, parse_cache_sizes("32K,1M,16M"), 8);
  const auto turns = [&](const LatticeOrder& order) {
    const Mesh mesh = in_order(lattice, order);
    return reuse_of(Kernel::assembly, vertex_graph(mesh), cut_into_simplices(mesh)).turns;
  };
  EXPECT_LT(turns({0}), turns({1}) / 2);
  EXPECT_EQ(vertex_graph(in_order(lattice, {0})).edge_count(), lattice.graph.edge_count());
}

TEST(Calibration, SheetsAreOfTriangles) {
  const CalibrationLattice sheet = make_calibration_lattice(900, true, parse_cache_sizes("32K,1M"), 4);
  EXPECT_EQ(sheet.mesh.vertex_count(), 900);
  EXPECT_EQ(sheet.mesh.cell_count(), 2 * 29 * 29);
  EXPECT_EQ(sheet.mesh.cells.highest_dimension(), 2);
  EXPECT_LE(sheet.orders.size(), 5U);
}

TEST(Calibration, MeasuresThisMachineInSmall) {
  const Calibration calibration =
      measure_machine({.seconds = 0.1, .probed = Offset{4} << 20, .vertices = 4000});
  EXPECT_FALSE(calibration.model.caches.level_bytes.empty());
  EXPECT_EQ(key_of(calibration), key_of_this_machine());
  EXPECT_GT(calibration.read_bandwidth, 0);
  EXPECT_GT(calibration.read_bandwidth_all, 0);
  EXPECT_EQ(calibration.date.size(), 10U);
  EXPECT_GT(calibration.seconds, 0);
  EXPECT_EQ(calibration.model.threads, 1);
  EXPECT_EQ(calibration.all_threads.threads, calibration.threads);
  EXPECT_EQ(calibration.all_threads.caches, calibration.model.caches);
  for (const auto& [model, quality] :
       {std::pair(&calibration.model, &calibration.quality),
        std::pair(&calibration.all_threads, &calibration.all_threads_quality)}) {
    for (std::size_t k = 0; k < kKernels.size(); ++k) {
      for (const int dimension : {2, 3}) {
        const CostRow costs = as_row(model->costs(kKernels[k], dimension));
        EXPECT_GT(std::accumulate(costs.begin(), costs.end(), 0.0), 0);
      }
      EXPECT_GE(quality->condition[k], 1);
      EXPECT_LT(quality->error[k], 1);
    }
  }
  EXPECT_EQ(parse_calibration(to_json_text(calibration)), calibration);
}

TEST(CalibrationStore, GivesBackWhatItWasGiven) {
  const test::TemporaryFolder folder;
  const Variable variable("MESHORDER_CACHE", (folder.path() / "deep").string());
  const Calibration calibration = made_up();
  EXPECT_FALSE(load_calibration(key_of_this_machine()).calibration);
  EXPECT_EQ(load_calibration(key_of_this_machine()).fault, "");
  const std::filesystem::path file = save_calibration(calibration);
  EXPECT_EQ(file, calibration_file(key_of_this_machine()));
  const StoredCalibration stored = load_calibration(key_of_this_machine());
  ASSERT_TRUE(stored.calibration);
  EXPECT_EQ(*stored.calibration, calibration);
  EXPECT_EQ(stored.fault, "");
  // nothing unfinished is left beside it
  const std::filesystem::directory_iterator files(file.parent_path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(CalibrationStore, KeepsInfiniteConditions) {
  Calibration calibration = made_up();
  calibration.quality.condition[2] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(parse_calibration(to_json_text(calibration)), calibration);
}

TEST(CalibrationStore, EveryProcessorCacheAndBuildHasAFileOfItsOwn) {
  const test::TemporaryFolder folder;
  const Variable variable("MESHORDER_CACHE", folder.path().string());
  const CalibrationKey key{"AMD EPYC  9R45 / x", "48K,1M,32M", "0.2.0, GNU 12"};
  const std::filesystem::path file = calibration_file(key);
  EXPECT_THAT(file.filename().string(), testing::StartsWith("AMD-EPYC-9R45-x-"));
  for (const CalibrationKey& other : {CalibrationKey{"AMD EPYC 9R45 / x", key.caches, key.build},
                                      CalibrationKey{key.processor, "48K,1M,16M", key.build},
                                      CalibrationKey{key.processor, key.caches, "0.2.0, GNU 13"}}) {
    EXPECT_NE(calibration_file(other), file);
    EXPECT_FALSE(load_calibration(other).calibration);
  }
}

TEST(CalibrationStore, AnotherMachinesFileIsNotTaken) {
  const test::TemporaryFolder folder;
  const Variable variable("MESHORDER_CACHE", folder.path().string());
  Calibration other = made_up();
  const std::filesystem::path file = save_calibration(other);
  other.processor = "another";
  std::ofstream(file) << to_json_text(other);
  const StoredCalibration stored = load_calibration(key_of_this_machine());
  EXPECT_FALSE(stored.calibration);
  EXPECT_THAT(stored.fault, HasSubstr("is of another machine or build"));
}

TEST(CalibrationStore, WhatIsNoFileIsNotWaitedFor) {
  const test::TemporaryFolder folder;
  const Variable variable("MESHORDER_CACHE", folder.path().string());
  const std::filesystem::path file = save_calibration(made_up());
  std::filesystem::remove(file);
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_THAT(load_calibration(key_of_this_machine()).fault, HasSubstr("is not used: "));
  std::filesystem::remove(file);
  std::filesystem::create_symlink("/dev/zero", file);
  EXPECT_THAT(load_calibration(key_of_this_machine()).fault, HasSubstr("is outside the folder"));
}

TEST(CalibrationStore, NoDamagedFileIsTaken) {
  const test::TemporaryFolder folder;
  const Variable variable("MESHORDER_CACHE", folder.path().string());
  const std::string text = to_json_text(made_up());
  const std::filesystem::path file = save_calibration(made_up());
  const auto fault_of = [&](const std::string& content) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
    const StoredCalibration stored = load_calibration(key_of_this_machine());
    EXPECT_FALSE(stored.calibration) << content;
    return stored.fault;
  };
  EXPECT_THAT(fault_of(""), HasSubstr("is empty"));
  EXPECT_THAT(fault_of("{}"), HasSubstr("is not a calibration"));
  EXPECT_THAT(fault_of("[1]"), HasSubstr("is not a calibration"));
  EXPECT_THAT(fault_of(R"({"schema": 3})"), HasSubstr("is not a calibration"));
  EXPECT_THAT(fault_of(test::with(text, "calibration 7", "calibration 6")),
              HasSubstr("is not a calibration"));
  EXPECT_THAT(fault_of(test::with(text, "\"spmv\"", "\"smpv\"")), HasSubstr("is damaged"));
  EXPECT_THAT(fault_of(test::with(text, "\"date\": \"2026-01-02\"", "\"date\": 7")), HasSubstr("is damaged"));
  EXPECT_THAT(fault_of(test::with(text, "\"access\": ", "\"access\": -")), HasSubstr("negative"));
  EXPECT_THAT(fault_of(test::with(text, "20971520", "1")), HasSubstr("not cache sizes"));
  EXPECT_THAT(fault_of(test::with(text, "\"threads\": 7", "\"threads\": 0")), HasSubstr("has no threads"));
  EXPECT_THAT(fault_of(test::with(text, "\"all_threads\"", "\"some_threads\"")), HasSubstr("is damaged"));
  for (std::size_t size = 0; size + 2 < text.size(); size += 37)
    EXPECT_NE(fault_of(text.substr(0, size)), "");
}

TEST(CalibrationStore, AFolderThatCannotBeMadeIsAnErrorWithARemedy) {
  const test::TemporaryFolder folder;
  const Variable variable("MESHORDER_CACHE", folder.file("file", "").string());
  try {
    (void)save_calibration(made_up());
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("; or set MESHORDER_CACHE to a folder"));
    EXPECT_EQ(error.code(), Code::io);
  }
}

TEST(MachineChoice, IsTheOneNamedThenTheVariableThenThisMachine) {
  const test::TemporaryFolder folder;
  const Variable cache("MESHORDER_CACHE", folder.path().string());
  const Variable machine("MESHORDER_MACHINE", "zen3");
  EXPECT_EQ(choose_machine("zen3").model, zen3_costs());
  EXPECT_EQ(choose_machine("zen3").in_words(), "zen3");
  EXPECT_EQ(choose_machine().name, "zen3");
  EXPECT_FALSE(choose_machine().stands_in);
  const MachineChoice prior = choose_machine("this");
  EXPECT_TRUE(prior.stands_in);
  const ShippedMachine& like = shipped_machines().front();
  EXPECT_EQ(prior.in_words(), "this machine's caches at the costs of " + std::string(like.name));
  EXPECT_EQ(prior.model.caches, caches_of_this_machine());
  EXPECT_EQ(prior.model.solid, like.costs().solid);
  (void)save_calibration(made_up());
  const MachineChoice calibrated = choose_machine("this");
  EXPECT_EQ(calibrated.in_words(), "this machine, calibrated 2026-01-02");
  EXPECT_EQ(calibrated.model, made_up().model);
  EXPECT_EQ(calibrated.floor, made_up().quality.floor);
  Calibration busy = made_up();
  busy.steadiness.waiting = 0.5;
  EXPECT_EQ(chosen(busy).in_words(), "this machine, calibrated 2026-01-02 while it was busy");
}

TEST(MachineChoice, OnAllThreadsIsACalibrationOnAsMany) {
  const test::TemporaryFolder folder;
  const Variable cache("MESHORDER_CACHE", folder.path().string());
  EXPECT_EQ(choose_machine("this", true).model.threads, 1);  // a substitute for one thread
  if (thread_count() > 1) {
    EXPECT_THROW((void)choose_machine("zen3", true), InvalidArgument);
  }
  Calibration calibration = made_up();
  calibration.threads = calibration.all_threads.threads = thread_count();
  (void)save_calibration(calibration);
  const MachineChoice all = choose_machine("this", true);
  EXPECT_EQ(all.model, calibration.all_threads);
  EXPECT_EQ(all.floor, calibration.all_threads_quality.floor);
  EXPECT_EQ(all.in_words(), "this machine" + on_threads(thread_count()) + ", calibrated 2026-01-02");
  calibration.threads = calibration.all_threads.threads = thread_count() + 1;
  (void)save_calibration(calibration);
  try {
    (void)choose_machine("this", true);
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr("; `meshorder calibrate` measures it again"));
  }
}

TEST(MachineChoice, UnknownNamesGetTheNearest) {
  const auto fault = [](const std::string& name) {
    try {
      (void)choose_machine(name);
    } catch (const InvalidArgument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(fault("zen6"), "unknown machine 'zen6'; did you mean 'zen3'?");
  EXPECT_EQ(fault("cray"), "unknown machine 'cray'; known: this, zen3");
  const Variable machine("MESHORDER_MACHINE", "cray");
  EXPECT_THAT(fault(""), HasSubstr("unknown machine 'cray'"));
}

TEST(PublicCalibrate, IsStoppedAndRefusesNoTime) {
  EXPECT_THROW((void)calibrate({.seconds = 0}), InvalidArgument);
  CalibrationOptions options;
  options.keep = false;
  options.run.progress = [](const Progress&) { return false; };
  EXPECT_THROW((void)calibrate(options), Stopped);
}

}  // namespace
}  // namespace meshorder
