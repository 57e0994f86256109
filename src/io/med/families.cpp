// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/text.hpp"
#include "io/labels.hpp"
#include "io/med/med.hpp"
#include "io/names.hpp"
#include "io/stream/read_limits.hpp"
#include "io/unsupported.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>
#include <type_traits>
#include <unordered_map>
#include <unordered_set>

// Families and groups: a family holds the vertices, or the cells, that belong to the same groups. The
// numbers of families are above 0 for vertices and below 0 for cells; family 0 belongs to no group.

namespace meshorder::med {
namespace {

constexpr std::string_view kFamilyZero = "FAMILLE_ZERO";
/// Labels become groups only if there are at most this many different ones.
constexpr std::size_t kMostLabels = 256;

std::size_t place_of(Association association) { return association == Association::vertices ? 0 : 1; }

/// Returns the numbers that an array gives to all vertices or cells; 0 for those without a row.
std::vector<std::int64_t> numbers_in(const Mesh& mesh, const std::string& name, Association association) {
  std::vector<std::int64_t> numbers = labels_of(mesh, association, name).values;
  numbers.resize(item_count(mesh, association), 0);
  return numbers;
}

/// Returns the families of a file in the order −1, −2, …, 1, 2, … Leaves out family 0 and repeated numbers.
std::vector<Family> families_in(const Reading& reading, const std::string& root) {
  std::vector<Family> families;
  std::unordered_set<std::int64_t> numbers;
  for (const std::string& name : reading.file.names(root)) {
    const std::string path = fmt::format("{}/{}", root, name);
    Family family{reading.file.integer_attribute(path, "NUM").value_or(0)};
    if (reading.file.has(path + "/GRO/NOM")) family.groups = reading.file.read_texts(path + "/GRO/NOM");
    std::erase(family.groups, "");
    for (std::string& group : family.groups) group = utf8(std::move(group));
    if (family.number != 0 && numbers.insert(family.number).second) families.push_back(std::move(family));
  }
  std::stable_sort(families.begin(), families.end(), [](const Family& a, const Family& b) {
    const bool a_below = a.number < 0;
    const bool b_below = b.number < 0;
    return a_below != b_below ? a_below : a_below ? a.number > b.number : a.number < b.number;
  });
  return families;
}

void read_families_of(Reading& reading, Association association) {
  MedLayout& layout = *reading.layout;
  std::vector<Family>& families = layout.families[place_of(association)];
  families = families_in(reading, layout.families_path(association));
  Mesh& mesh = reading.mesh;
  std::vector<EntitySet> sets;
  std::unordered_map<std::string, std::size_t> set_of_name;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> sets_of_family;
  for (Family& family : families) {
    for (const std::string& group : family.groups) {
      const auto [found, is_new] = set_of_name.emplace(group, sets.size());
      if (is_new) sets.push_back({group, association, {}});
      sets_of_family[family.number].push_back(found->second);
    }
    std::sort(family.groups.begin(), family.groups.end());
    family.groups.erase(std::unique(family.groups.begin(), family.groups.end()), family.groups.end());
  }
  const std::vector<std::int64_t> numbers = numbers_in(mesh, layout.families_array, association);
  const std::vector<std::size_t>* of_last = nullptr;
  std::int64_t last = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] == 0) continue;
    if (numbers[i] != last) {
      const auto found = sets_of_family.find(numbers[i]);
      of_last = found == sets_of_family.end() ? nullptr : &found->second;
      last = numbers[i];
    }
    if (of_last == nullptr) continue;
    if (of_last->size() > 1) claim_memory(of_last->size() * sizeof(Index), "items in several groups");
    for (const std::size_t set : *of_last) {
      // a family may name a group twice
      std::vector<Index>& members = sets[set].members;
      if (members.empty() || members.back() != static_cast<Index>(i))
        members.push_back(static_cast<Index>(i));
    }
  }
  for (EntitySet& set : sets) {
    if (!set.members.empty()) mesh.sets.push_back(std::move(set));
  }
}

/// The family and the groups of some vertices or cells. The groups form a chain of combinations, one group in
/// each, as an item may be in thousands of groups.
struct Combination {
  std::int64_t family;
  std::size_t without_last;       ///< index of the combination without `last_group`
  const std::string* last_group;  ///< null: no groups
};

class FamilyWriter {
 public:
  FamilyWriter(Writing& writing, Association association) : writing_(writing), association_(association) {
    for (const Family& family : writing.layout.families[place_of(association)]) remember(family);
  }

  std::vector<std::int64_t> write() {
    start();
    add_sets();
    std::vector<bool> is_used(combinations_.size(), false);
    for (const std::size_t combination : of_item_) is_used[combination] = true;
    std::vector<std::int64_t> number_of(combinations_.size(), 0);
    for (std::size_t c = 0; c < number_of.size(); ++c) {
      if (is_used[c]) number_of[c] = number_for(family_of(c));
    }
    if (std::all_of(number_of.begin(), number_of.end(), [](std::int64_t number) { return number == 0; })) {
      return {};
    }
    std::vector<std::int64_t> numbers;
    numbers.reserve(of_item_.size());
    for (const std::size_t combination : of_item_) numbers.push_back(number_of[combination]);
    return numbers;
  }

 private:
  /// Gives each item its family in the MED file that the mesh came from, and no groups.
  void start() {
    const MedLayout& layout = writing_.layout;
    const Mesh& mesh = writing_.mesh;
    std::vector<std::int64_t> families;
    if (layout.is_made) {
      families.resize(item_count(mesh, association_), 0);
    } else {
      writing_.placed.insert(label_array(mesh, association_, layout.families_array));
      families = numbers_in(mesh, layout.families_array, association_);
    }
    of_item_.reserve(families.size());
    std::unordered_map<std::int64_t, std::size_t> known;
    std::size_t last = 0;  // neighbouring items mostly have the same family
    for (const std::int64_t family : families) {
      if (combinations_.empty() || combinations_[last].family != family) {
        const auto [found, is_new] = known.try_emplace(family, combinations_.size());
        if (is_new) combinations_.push_back({family, 0, nullptr});
        last = found->second;
      }
      of_item_.push_back(last);
    }
  }

  /// Adds a group with these members.
  void add_group(std::string name, const std::vector<Index>& members) {
    const std::string& group = groups_.emplace_back(std::move(name));
    std::unordered_map<std::size_t, std::size_t> with_group;
    for (const Index member : members) {
      std::size_t& own = of_item_[member];
      const auto [found, is_new] = with_group.try_emplace(own, combinations_.size());
      if (is_new) combinations_.push_back({combinations_[own].family, own, &group});
      own = found->second;
    }
  }

  /// Returns the groups of a combination, with the number of its old family.
  [[nodiscard]] Family family_of(std::size_t combination) const {
    const Combination* link = &combinations_[combination];
    Family result{link->family};
    for (; link->last_group != nullptr; link = &combinations_[link->without_last]) {
      result.groups.push_back(*link->last_group);
    }
    std::reverse(result.groups.begin(), result.groups.end());
    return result;
  }

  void add_sets() {
    DistinctNames names(kLongestGroup);
    bool any = false;
    for (const EntitySet& set : writing_.mesh.sets) {
      if (set.association != association_) continue;
      if (set.members.empty()) {
        note_set_empty(set, writing_.notes);
        continue;
      }
      add_group(unused_name(set.name, names), set.members);
      any = true;
    }
    if (!any && writing_.layout.is_made) add_labels();
  }

  /// Makes groups from the labels of a mesh that has no sets.
  void add_labels() {
    const Labels labels = labels_of(writing_.mesh, association_);
    std::map<std::int64_t, std::vector<Index>> members;
    for (std::size_t i = 0; i < labels.values.size(); ++i) {
      if (labels.values[i] != 0) members[labels.values[i]].push_back(static_cast<Index>(i));
      if (members.size() > kMostLabels) return;
    }
    for (const auto& [label, of_label] : members) {
      add_group(fmt::format("{}_{}", kLabel, label), of_label);
    }
    if (association_ == Association::cells) {
      note_number_markers(writing_.mesh, "groups named label_N", writing_.notes);
    }
  }

  /// Returns an unused name for a group, without blanks at its end: the file pads names with blanks.
  std::string unused_name(const std::string& name, DistinctNames& names) {
    const std::string plain = plain_name(utf8(name));
    const std::string_view held = std::string_view(plain).substr(0, plain.find_last_not_of(' ') + 1);
    std::string result = names.take(held.empty() ? "group" : held);
    if (result != name) {
      writing_.notes.push_back(fmt::format("the set '{}' of {} is written as the group '{}'", name,
                                           to_string(association_), result));
    }
    return result;
  }

  /// Returns the number of a family with the groups of `wanted`: `wanted.number` if that family of the file
  /// has these groups (a missing family has none), else the number of the first family that has them, else 0
  /// for no groups, else a new number.
  std::int64_t number_for(const Family& wanted) {
    std::vector<std::string> groups = wanted.groups;
    std::sort(groups.begin(), groups.end());
    const auto own = groups_of_.find(wanted.number);
    if (own != groups_of_.end() && own->second == groups) return own->first;
    const bool is_unknown = own == groups_of_.end();
    if (is_unknown && groups.empty()) return wanted.number;
    const auto other = number_of_.find(groups);
    if (other != number_of_.end()) return other->second;
    if (groups.empty()) return 0;
    return add_family(groups, wanted.groups);
  }

  /// Records a family of the file. Of several families with the same groups, the first one is used.
  void remember(const Family& family) {
    constexpr std::int64_t kMost = 2147483647;
    groups_of_.try_emplace(family.number, family.groups);
    number_of_.try_emplace(family.groups, family.number);
    if (family.number < -kMost || family.number > kMost) return;
    last_ = association_ == Association::vertices ? std::max(last_, family.number)
                                                  : std::min(last_, family.number);
  }

  /// Writes a new family and returns its number.
  std::int64_t add_family(const std::vector<std::string>& sorted, const std::vector<std::string>& groups) {
    const std::int64_t number = association_ == Association::vertices ? last_ + 1 : last_ - 1;
    remember({number, sorted});
    hdf5::File& file = writing_.file;
    const std::string root = writing_.layout.families_path(association_);
    // the library lists the families of files before version 3.2 by name, and others as made
    std::string name(utf8_prefix(fmt::format("FAM_{:07}_{}", number, fmt::join(groups, "_")), kLongestName));
    std::replace(name.begin(), name.end(), '/', '_');
    for (int k = 2; file.has(fmt::format("{}/{}", root, name)); ++k)
      name = fmt::format("FAM_{:07}_{}", number, k);
    const std::string path = root + "/" + name;
    file.make_group(root, hdf5::File::LinkOrder::made);
    file.make_group(path + "/GRO");
    file.set_attribute(path, "NUM", number);
    file.set_attribute(path + "/GRO", "NBR", std::int64_t{std::ssize(groups)});
    file.write_texts(path + "/GRO/NOM", groups, kLongestGroup);
    return number;
  }

  Writing& writing_;
  Association association_;
  std::vector<Combination> combinations_;
  std::vector<std::size_t> of_item_;  // the combination of each vertex or cell
  std::deque<std::string> groups_;
  std::map<std::int64_t, std::vector<std::string>> groups_of_;  // groups of each family, by its number
  std::map<std::vector<std::string>, std::int64_t> number_of_;  // first family with the groups
  std::int64_t last_ = 0;  // family number farthest from 0 within 32 bits
};

}  // namespace

std::string MedLayout::families_path(Association association) const {
  return fmt::format("/FAS/{}/{}", mesh, association == Association::vertices ? "NOEUD" : "ELEME");
}

void read_families(Reading& reading) {
  read_families_of(reading, Association::vertices);
  read_families_of(reading, Association::cells);
}

std::vector<std::int64_t> write_families(Writing& writing, Association association) {
  const std::string zero = fmt::format("/FAS/{}/{}", writing.layout.mesh, kFamilyZero);
  if (!writing.file.has(zero)) {
    writing.file.make_group(zero);
    writing.file.set_attribute(zero, "NUM", std::int64_t{0});
  }
  return FamilyWriter(writing, association).write();
}

}  // namespace meshorder::med
