// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/stepper.hpp"

#include "io/format.hpp"
#include "io/npy.hpp"
#include "lab/scenario/motion_metrics.hpp"
#include "lab/scenario/simulation.hpp"
#include "mesh/procedural.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sstream>
#include <string>
#include <vector>

namespace meshorder {
namespace {

using nlohmann::json;

/// The stepper's answers to these questions.
std::vector<json> answers_to(const std::vector<json>& questions) {
  std::stringstream in, out;
  for (const json& question : questions) in << question.dump() << '\n';
  serve_steps(in, out);
  std::vector<json> answers;
  for (std::string line; std::getline(out, line);) answers.push_back(json::parse(line));
  return answers;
}

TEST(StepperMessages, HoldPathsOfAnyBytes) {
  const auto sent = [](const json& message) { return json::parse(message.dump()); };
  const StepperTurn turn =
      read_message<StepperTurn>(sent(message_of(StepperTurn{1, "\xff.npy", 1, true, "\xfe/é"})));
  EXPECT_EQ(turn.frames, "\xff.npy");
  EXPECT_EQ(turn.surfaces, "\xfe/é");
  const StepperTask task = read_message<StepperTask>(sent(message_of(StepperTask{"\xf0",
                                                                                 "mesh\xff.vtu",
                                                                                 "\x80v",
                                                                                 "\x81"
                                                                                 "c",
                                                                                 {}})));
  EXPECT_EQ(task.scenario, "\xf0");
  EXPECT_EQ(task.mesh, "mesh\xff.vtu");
  EXPECT_EQ(task.vertex_order, "\x80v");
  EXPECT_EQ(task.cell_order,
            "\x81"
            "c");
}

class Steps : public testing::Test {
 protected:
  Steps() : mesh_(make_ball({.size = 3})) { write_mesh(mesh_, file("ball.vtu")); }

  [[nodiscard]] std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  [[nodiscard]] StepperTask task() const { return {"falling", file("ball.vtu"), "", "", {}}; }

  test::TemporaryFolder folder_;
  Mesh mesh_;
};

TEST_F(Steps, AreThoseOfTheSimulation) {
  StepperTurn turn{3, file("motion.npy"), 2, false};
  std::vector<json> questions{message_of(task()), message_of(turn)};
  turn.last = true;
  questions.push_back(message_of(turn));
  const std::vector<json> answers = answers_to(questions);
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_EQ(read_message<StepperReady>(answers[0]).vertices, mesh_.vertex_count());
  EXPECT_DOUBLE_EQ(read_message<StepperReady>(answers[0]).longest_side, 10);  // the scenario's scale
  const auto times = read_message<RunRecord>(answers[2]);
  EXPECT_EQ(times.step_seconds.size(), 3U);
  EXPECT_GT(times.cg_iterations, 0);
  EXPECT_GT(times.seconds.solve, 0);

  // the first step, a warm-up, was undone: six steps, not seven
  Simulation simulation = set_up(find_scenario("falling"), mesh_, "ball.vtu");
  const Motion motion = read_motion(file("motion.npy"));
  ASSERT_EQ(motion.frames.size(), 4U);  // steps 0, 2, 4, 6
  for (Index step = 0; step <= 6; ++step) {
    if (step > 0) simulation.body->step();
    if (step % 2 != 0) continue;
    const MotionState state = simulation.body->state();
    for (Index v = 0; v < mesh_.vertex_count(); ++v)
      EXPECT_EQ(motion.frames[step / 2][v][1], static_cast<float>(state.positions[v][1]));
  }
}

TEST_F(Steps, GiveTheirFramesInTheMeshsOwnOrder) {
  const Permutation vertices = test::shuffled(mesh_.vertex_count(), 1);
  const Permutation cells = test::shuffled(mesh_.cells.size(), 2);
  write_npy(vertices.old_to_new(), file("v.npy"));
  write_npy(cells.old_to_new(), file("c.npy"));
  StepperTask shuffled = task();
  shuffled.vertex_order = file("v.npy");
  shuffled.cell_order = file("c.npy");
  for (const auto& [asked, name] : {std::pair(task(), "own.npy"), std::pair(shuffled, "shuffled.npy")})
    ASSERT_EQ(answers_to({message_of(asked), message_of(StepperTurn{4, file(name), 1, true})}).size(), 2U);
  const Motion own = read_motion(file("own.npy"));
  EXPECT_LT(difference_of(read_motion(file("shuffled.npy")), own, 10).largest, 1e-6);
}

TEST_F(Steps, SayWhatIsWrongAndEnd) {
  const auto complaint = [](const json& question) {
    const std::vector<json> answers = answers_to({question, question});
    EXPECT_EQ(answers.size(), 1U);
    return answers[0].value("error", "");
  };
  EXPECT_NE(complaint({{"nonsense", 1}}), "");
  StepperTask other = task();
  other.mesh = file("none.vtu");
  EXPECT_NE(complaint(message_of(other)).find("none.vtu"), std::string::npos);
  other = task();
  write_npy(std::vector<Index>{0, 1, 2}, file("short.npy"));
  other.vertex_order = file("short.npy");
  EXPECT_NE(complaint(message_of(other)).find("maps 3 vertices"), std::string::npos);
}

TEST_F(Steps, FindTheSameMeshByItsFingerprint) {
  const auto fingerprint = [&] {
    return read_message<StepperReady>(answers_to({message_of(task())})[0]).fingerprint;
  };
  const std::string before = fingerprint();
  EXPECT_EQ(fingerprint(), before);
  mesh_.points[0][0] += 1e-9;
  write_mesh(mesh_, file("ball.vtu"));
  EXPECT_NE(fingerprint(), before);
}

}  // namespace
}  // namespace meshorder
