// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/nastran/systems.hpp"

#include "base/point.hpp"
#include "io/stream/scanner.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace meshorder::nastran {
namespace {

constexpr int kMostOpen = 100;  // systems in a chain in which each refers to the next

Point in_frame_directions(double radius, double angle, double z) {
  const double radians = angle * std::numbers::pi / 180;
  return {radius * std::cos(radians), radius * std::sin(radians), z};
}

}  // namespace

void CoordinateSystems::add(std::string_view name, const CardFields& fields, std::size_t byte) {
  constexpr std::size_t kLength = 6;
  constexpr std::string_view kKinds = "RCS";  // as in `Kind`
  if (name.size() != kLength || !name.starts_with("CORD") || (name[4] != '1' && name[4] != '2')) return;
  const std::size_t kind = kKinds.find(name[5]);
  if (kind == std::string_view::npos) return;
  System system;
  system.kind = static_cast<Kind>(kind);
  if (!fields.fault.empty())
    file_.fail(byte, std::string(fields.fault),
               "write it in fields of 8 or 16 columns, its lines one after the other");
  system.byte = byte;
  const auto number = [&](std::size_t field) {
    const std::int64_t result = number_of(fields.text(field));
    if (result == 0) {
      file_.fail(byte, fmt::format("field {} of {} is '{}'", field + 1, name, shown(fields.text(field))),
                 "a number above 0 is needed");
    }
    return result;
  };
  if (name[4] == '1') {
    system.by_nodes = true;
    constexpr std::size_t kSecond = 5;  // a card may give two systems
    for (const std::size_t first : {std::size_t{1}, kSecond}) {
      if (first == kSecond && fields.text(first).empty()) continue;
      for (std::size_t k = 0; k < 3; ++k) system.nodes[k] = number(first + 1 + k);
      add(number(first), system);
    }
    return;
  }
  const std::string_view reference = fields.text(2);
  if (!reference.empty() && reference != "0") system.reference = number(2);
  for (std::size_t k = 0; k < 9; ++k) {
    const std::string_view text = fields.text(3 + k);
    const auto value = text.empty() ? 0.0 : real_of(text);
    if (!value) {
      file_.fail(byte, fmt::format("a coordinate of {} is '{}'", name, shown(text)),
                 "a finite number is needed");
    }
    system.points[k / 3][k % 3] = *value;
  }
  add(number(1), system);
}

void CoordinateSystems::add(std::int64_t number, const System& system) {
  if (systems_.emplace(number, system).second) return;
  file_.fail(system.byte, fmt::format("the coordinate system {} is given twice", number),
             "numbers must differ");
}

Point CoordinateSystems::in_basic(std::int64_t system, const Point& point, std::size_t byte,
                                  const NodePosition& node_position) {
  if (system == 0) return point;
  const auto found = systems_.find(system);
  if (found == systems_.end()) {
    file_.fail(byte, fmt::format("the coordinate system {} is not given", system),
               "add its CORD2R or the like, or the file that has it");
  }
  const Frame& frame = frame_of(found->second, node_position);
  Point along = point;
  if (found->second.kind == Kind::cylindrical) along = in_frame_directions(point[0], point[1], point[2]);
  if (found->second.kind == Kind::spherical) {
    const Point meridian = in_frame_directions(point[0], point[1], 0);  // component 0 is along the z-axis
    along = in_frame_directions(meridian[1], point[2], meridian[0]);
  }
  Point result = frame.origin;
  for (std::size_t k = 0; k < 3; ++k) result = plus_scaled(result, along[k], frame.axes[k]);
  if (!is_finite(result)) file_.fail(byte, "a node is too far away", "correct its coordinates");
  return result;
}

const CoordinateSystems::Frame& CoordinateSystems::frame_of(System& system,
                                                            const NodePosition& node_position) {
  if (system.has_frame) return system.frame;
  if (system.is_open || open_ >= kMostOpen) {
    file_.fail(system.byte, "the coordinate system refers to itself, or the chain of systems is too long",
               "correct it");
  }
  system.is_open = true;
  ++open_;
  std::array<Point, 3> points{};
  for (std::size_t k = 0; k < 3; ++k) {
    points[k] = system.by_nodes ? node_position(system.nodes[k], system.byte)
                                : in_basic(system.reference, system.points[k], system.byte, node_position);
  }
  --open_;
  system.is_open = false;
  const Point z = minus(points[1], points[0]);
  const Point y = cross(z, minus(points[2], points[0]));
  if (!(norm(z) > 0) || !(norm(y) > 0)) {
    file_.fail(system.byte, "the three points of the coordinate system are on a line", "correct them");
  }
  system.frame.origin = points[0];
  system.frame.axes[2] = scaled(1 / norm(z), z);
  system.frame.axes[1] = scaled(1 / norm(y), y);
  system.frame.axes[0] = cross(system.frame.axes[1], system.frame.axes[2]);
  system.has_frame = true;
  return system.frame;
}

}  // namespace meshorder::nastran
