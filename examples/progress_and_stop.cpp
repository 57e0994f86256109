// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Shows the progress of an order and stops it when the user asks for it.
#include <meshorder/error.hpp>
#include <meshorder/order.hpp>

#include <cstdint>
#include <cstdio>
#include <string_view>
#include <vector>

namespace mo = meshorder;

namespace {

// These two replace a window's progress bar and button. The button counts as pressed after `presses_after`
// calls.
struct Bar {
  int shown = 0;
  bool cleared = false;
  void show(std::string_view stage, double fraction) {
    ++shown;
    if (fraction >= 0) {
      std::printf("%.*s: %.0f %%\n", static_cast<int>(stage.size()), stage.data(), 100 * fraction);
    } else {
      std::printf("%.*s …\n", static_cast<int>(stage.size()), stage.data());
    }
  }
  void clear() { cleared = true; }
};

struct Button {
  int presses_after;
  [[nodiscard]] bool pressed() { return presses_after-- <= 0; }
};

// The graph of a grid of side × side vertices, numbered from 1 in unsigned 64-bit integers, as some callers'
// arrays are.
struct Grid {
  std::vector<std::uint64_t> offsets{1};
  std::vector<std::uint64_t> neighbours;
};

Grid grid(std::uint64_t side) {
  Grid result;
  for (std::uint64_t v = 0; v < side * side; ++v) {
    if (v >= side) result.neighbours.push_back(v + 1 - side);
    if (v % side > 0) result.neighbours.push_back(v);
    if (v % side + 1 < side) result.neighbours.push_back(v + 2);
    if (v + side < side * side) result.neighbours.push_back(v + 1 + side);
    result.offsets.push_back(result.neighbours.size() + 1);
  }
  return result;
}

// Returns true if the order was found, false if the button stopped it.
bool order_in_window(const mo::GraphView& graph, Bar& bar, Button& button) {
  try {
    const mo::Order order =
        mo::order_vertices(graph, "spectral", {.run = {.threads = 4, .progress = [&](const mo::Progress& p) {
                                                         bar.show(p.stage, p.fraction);
                                                         return !button.pressed();
                                                       }}});
    std::printf("%d vertices in %.2f s\n", order.permutation.size(), order.seconds);
    return true;
  } catch (const mo::Stopped&) {
    bar.clear();
    return false;
  }
}

}  // namespace

int main() {
  const Grid arrays = grid(300);
  const mo::GraphView graph{arrays.offsets, arrays.neighbours, {}, 1};

  Bar patient;
  Button untouched{1'000'000'000};
  const bool found = order_in_window(graph, patient, untouched);

  Bar interrupted;
  Button pressed_soon{1};
  const bool stopped = !order_in_window(graph, interrupted, pressed_soon);
  return found && patient.shown > 0 && stopped && interrupted.cleared ? 0 : 1;
}
