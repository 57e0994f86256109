// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// JSON files: values are exchanged, lists grow and shrink, keys are added and removed. The file stays valid
// JSON and gets another meaning.
#include "fuzz/families/families.hpp"
#include "fuzz/mutators/choice.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

namespace meshorder::fuzz {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostDepth = 100;
constexpr std::size_t kMostText = 1024;  // bytes of a text that is changed

/// A value, and the list or object that holds it.
struct Place {
  Json* value;
  Json* owner;
  std::size_t index;  ///< in the owner
};

/// Adds the places of all values in a list or an object. Returns false if they are nested too deep.
bool add_places(Json& owner, std::vector<Place>& places, int depth = 0) {
  if (depth == kMostDepth) return false;
  std::size_t index = 0;
  for (Json& value : owner) {
    places.push_back({&value, &owner, index++});
    if (value.is_structured() && !add_places(value, places, depth + 1)) return false;
  }
  return true;
}

/// Returns a number near `number`, or a number that is often handled wrongly.
Json other_number(const Json& number, Choice& choice) {
  const std::array<Json, 8> numbers{0,
                                    -1,
                                    0.5,
                                    1e308,
                                    std::numeric_limits<std::int32_t>::max(),
                                    std::int64_t{1} << 31U,
                                    std::numeric_limits<std::int64_t>::max(),
                                    std::numeric_limits<std::uint64_t>::max()};
  if (choice.below(2) == 0) return numbers[choice.below(numbers.size())];
  if (number.is_number_float()) return number.get<double>() * (choice.below(2) == 0 ? 2 : -0.5);
  return number.get<std::uint64_t>() + choice.below(5) - 2;  // may wrap around
}

/// Returns another number, truth value or short text; null for values of other kinds.
Json other_value(const Json& value, Choice& choice) {
  if (value.is_number()) return other_number(value, choice);
  if (value.is_boolean()) return !value.get<bool>();
  if (value.is_string() && value.get_ref<const std::string&>().size() <= kMostText) {
    const auto& text = value.get_ref<const std::string&>();
    return mutated_bytes(text, text.size() + kTextRoom);
  }
  return nullptr;
}

/// Gives a value in an object the key of another value.
void change_key(const Place& place, const Place& other) {
  const std::string key = std::next(other.owner->begin(), static_cast<std::ptrdiff_t>(other.index)).key();
  Json value = *place.value;
  place.owner->erase(std::next(place.owner->begin(), static_cast<std::ptrdiff_t>(place.index)));
  (*place.owner)[key] = std::move(value);
}

void change(const Place& place, const Place& other, Choice& choice) {
  Json& owner = *place.owner;
  const auto at = std::next(owner.begin(), static_cast<std::ptrdiff_t>(place.index));
  switch (choice.below(6)) {
    case 0:
      owner.erase(at);
      break;
    case 1:
      if (owner.is_array()) owner.insert(at, Json(*place.value));
      break;
    case 2:
      *place.value = Json(*other.value);
      break;
    case 3:
      if (owner.is_object() && other.owner->is_object()) change_key(place, other);
      break;
    default:
      *place.value = other_value(*place.value, choice);
  }
}

}  // namespace

std::string mutate_json(std::string input, std::uint32_t seed) {
  Choice choice(seed);
  Json json = Json::parse(input, nullptr, false);
  std::vector<Place> places;
  if (!json.is_structured() || !add_places(json, places) || places.empty()) return {};
  const Place& place = places[choice.below(places.size())];
  change(place, places[choice.below(places.size())], choice);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace meshorder::fuzz
