// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/nastran/deck_text.hpp"
#include <meshorder/mesh.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string_view>

namespace meshorder::nastran {

/// The coordinate systems of a deck, in which nodes may be given: CORD1R, CORD1C, CORD1S by three nodes,
/// CORD2R, CORD2C, CORD2S by three points. A system may be given in another system. 0 is the basic system.
/// Angles are in degrees (MSC Nastran Quick Reference Guide, "CORD2R").
class CoordinateSystems {
 public:
  /// Returns the position of a node in the basic system; `byte` is the byte of the card that names the node.
  using NodePosition = std::function<Point(std::int64_t node, std::size_t byte)>;

  explicit CoordinateSystems(const DeckText& file) : file_(file) {}

  /// Adds the systems of a card that begins at that byte; ignores other cards. Throws InputError for faulty
  /// fields and for a system that was given before.
  void add(std::string_view name, const CardFields& fields, std::size_t byte);

  /// Converts a point from a system to the basic system. Throws InputError for a missing or faulty system and
  /// if the result is not finite.
  ///
  /// @param byte  of the card that names the system
  [[nodiscard]] Point in_basic(std::int64_t system, const Point& point, std::size_t byte,
                               const NodePosition& node_position);

 private:
  enum class Kind : std::uint8_t { rectangular, cylindrical, spherical };
  struct Frame {
    Point origin;
    std::array<Point, 3> axes;
  };
  struct System {
    Kind kind = Kind::rectangular;
    bool by_nodes = false;
    std::int64_t reference = 0;     // system of the points
    std::array<Point, 3> points{};  // the origin, a point on the z-axis, a point in the plane of x and z
    std::array<std::int64_t, 3> nodes{};  // in place of `points`
    std::size_t byte = 0;
    bool has_frame = false;
    bool is_open = false;  // the computation of its frame has begun, not ended
    Frame frame{};
  };

  void add(std::int64_t number, const System& system);
  const Frame& frame_of(System& system, const NodePosition& node_position);

  const DeckText& file_;
  std::map<std::int64_t, System> systems_;
  int open_ = 0;
};

}  // namespace meshorder::nastran
