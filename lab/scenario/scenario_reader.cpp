// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "io/stream/scanner.hpp"
#include "lab/scenario/integrator_reader.hpp"
#include "lab/scenario/scenario.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace meshorder {
namespace {
namespace fs = std::filesystem;

constexpr Index kMostSteps = 1'000'000;

/// Reads "all", {"set": …}, {"label": …}, {"box": …} or {"nearest": …}.
VertexChoice vertex_choice(const JsonValue& value) {
  VertexChoice choice;
  choice.source_path = value.path();
  if (value.is_text()) {
    if (value.text() != "all")
      throw value.error("'" + value.text() + "' is unknown",
                        R"(give "all", or {"set": NAME}, {"label": 3}, {"box": […]}, {"nearest": […]})");
    return choice;
  }
  value.expect_keys({"set", "label", "array", "box", "nearest"});
  int kinds = 0;
  for (const std::string_view kind : {"set", "label", "box", "nearest"}) kinds += value.has(kind) ? 1 : 0;
  if (kinds != 1) throw value.error("does not say which vertices", "give one of set, label, box, nearest");
  if (value.has("array") && !value.has("label"))
    throw value.error("has an array without a label", "give the label that its vertices or cells have");
  if (value.has("set")) {
    choice.by = VertexChoice::By::set;
    choice.name = value["set"].text();
  } else if (value.has("label")) {
    choice.by = VertexChoice::By::label;
    choice.label = value["label"].whole(std::numeric_limits<std::int64_t>::min(),
                                        std::numeric_limits<std::int64_t>::max());
    if (value.has("array")) choice.name = value["array"].text();
  } else if (value.has("box")) {
    choice.by = VertexChoice::By::box;
    const std::vector<JsonValue> corners = value["box"].items(2, 2);
    choice.low = corners[0].vector();
    choice.high = corners[1].vector();
    for (int a = 0; a < 3; ++a) {
      if (choice.low[a] > choice.high[a])
        throw corners[1].error("lies below the first corner", "give the lower corner, then the upper one");
    }
  } else {
    choice.by = VertexChoice::By::nearest;
    choice.low = value["nearest"].vector();
  }
  return choice;
}

StepRange step_range(const JsonValue& owner) {
  StepRange range;
  if (const auto steps = owner.find("steps")) {
    const std::vector<JsonValue> ends = steps->items(2, 2);
    range.first = static_cast<Index>(ends[0].whole(1, kMaxIndex));
    range.last = static_cast<Index>(ends[1].whole(range.first, kMaxIndex));
  }
  return range;
}

void read_order(const JsonValue& value, Scenario& scenario) {
  value.expect_keys({"vertices", "elements", "every"});
  if (const auto vertices = value.find("vertices")) scenario.vertex_order = vertices->text();
  if (const auto elements = value.find("elements")) scenario.element_order = elements->text();
}

void read_mesh_name(const JsonValue& root, Scenario& scenario) {
  if (root.has("water")) {
    for (const std::string_view key : {"mesh", "scale", "place", "start", "forces", "fixed", "prescribed"}) {
      if (const auto value = root.find(key))
        throw value->error("is unknown to water, which makes its own mesh", "leave it out");
    }
    return;
  }
  scenario.mesh = root["mesh"].text();
  if (names_a_model(scenario.mesh)) return;
  scenario.mesh_folder = fs::path(root.file()).parent_path();
  scenario.mesh = (*scenario.mesh_folder / scenario.mesh).string();
}

void read_scale(const JsonValue& value, Scenario& scenario) {
  value.expect_keys({"longest_side", "height"});
  if (value.has("longest_side") == value.has("height"))
    throw value.error("does not say which side to scale", "give longest_side or height");
  if (const auto height = value.find("height")) {
    scenario.height = height->number(kPositive);
  } else {
    scenario.longest_side = value["longest_side"].number(kPositive);
  }
}

void read_events(const JsonValue& value, Scenario& scenario) {
  if (const auto start = value.find("start")) {
    for (const JsonValue& some : start->items()) {
      some.expect_keys({"on", "velocity", "at"});
      ScenarioStart& read = scenario.start.emplace_back();
      read.on = vertex_choice(some["on"]);
      if (const auto velocity = some.find("velocity")) read.velocity = velocity->vector();
      if (const auto at = some.find("at")) read.at = at->vector();
      if (!read.velocity && !read.at) throw some.error("has neither velocity nor at", "give one of them");
    }
  }
  if (const auto forces = value.find("forces")) {
    for (const JsonValue& force : forces->items()) {
      force.expect_keys({"on", "newtons", "steps"});
      scenario.forces.push_back({vertex_choice(force["on"]), step_range(force), force["newtons"].vector()});
    }
  }
  if (const auto fixed = value.find("fixed")) {
    for (const JsonValue& some : fixed->items()) {
      some.expect_keys({"on", "steps"});
      scenario.motions.push_back({vertex_choice(some["on"]), step_range(some), {}});
    }
  }
  if (const auto prescribed = value.find("prescribed")) {
    for (const JsonValue& motion : prescribed->items()) {
      motion.expect_keys({"on", "velocity", "steps"});
      scenario.motions.push_back(
          {vertex_choice(motion["on"]), step_range(motion), motion["velocity"].vector()});
    }
  }
}

/// Reads paths of values in the file, such as "material.young".
std::vector<std::string> read_paths(const JsonValue& root, const JsonValue& list) {
  std::vector<std::string> result;
  for (const JsonValue& entry : list.items()) {
    result.push_back(entry.text());
    JsonValue at = root;
    for (std::string_view rest = result.back(); !rest.empty();) {
      const std::size_t end = std::min(rest.find('.'), rest.size());
      const auto next = at.find(rest.substr(0, end));
      if (!next) throw entry.error("'" + result.back() + "' is not in the file", "name a value of the file");
      at = *next;
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  return result;
}

}  // namespace

bool names_a_model(std::string_view mesh) {
  return mesh.find('/') == std::string_view::npos && std::filesystem::path(mesh).extension().empty();
}

Scenario parse_scenario(std::string_view text, const std::string& file) {
  const nlohmann::json json = parse_json(text, file);
  const JsonValue root(json, file);
  root.expect_keys({"$schema", "name", "title", "mesh", "water", "scale", "place", "order", "material",
                    "integrator", "solver", "contact", "start", "forces", "fixed", "prescribed", "steps",
                    "paper", "notes"});
  Scenario scenario;
  scenario.file = file;
  scenario.name = root["name"].name_in_files();
  if (const auto title = root.find("title")) scenario.title = title->text();
  read_mesh_name(root, scenario);
  if (const auto scale = root.find("scale")) read_scale(*scale, scenario);
  if (const auto place = root.find("place")) {
    place->expect_keys({"bottom"});
    scenario.bottom = (*place)["bottom"].vector();
  }
  if (const auto order = root.find("order")) read_order(*order, scenario);
  read_integrator(root, scenario);
  read_events(root, scenario);
  scenario.steps = static_cast<Index>(root["steps"].whole(1, kMostSteps));
  if (const auto paper = root.find("paper")) scenario.paper = read_paths(root, *paper);
  if (const auto notes = root.find("notes")) {
    for (const JsonValue& note : notes->items()) scenario.notes.push_back(note.text());
  }
  return scenario;
}

Scenario read_scenario(const std::filesystem::path& path) {
  const Scanner file(path);
  if (const Format* const format = format_of_bytes(file.all())) {
    throw InputError(path.string(), fmt::format("is not a scenario but a file of {}", format->name),
                     "give the name or the file of a scenario, and a mesh with --mesh");
  }
  return parse_scenario(file.all(), path.string());
}

}  // namespace meshorder
