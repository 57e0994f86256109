// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "fuzz/exodus_seed.hpp"

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::fuzz {
namespace {

using exodus::NcOutput;
using exodus::NcSink;
using exodus::NcType;

constexpr std::size_t kNameLength = 33;

/// Declares dimensions and variables of a file, each variable after its dimensions.
class Variables {
 public:
  explicit Variables(NcOutput& file) : file_(file) {}

  /// Declares a variable with the numbers first, first + 1, …, as many as its dimensions need.
  void counted(const std::string& name, NcType type, const std::vector<std::string>& dimensions, double first,
               const std::vector<exodus::Attribute>& attributes = {}) const {
    std::vector<double> values(product(sizes(dimensions)));
    std::iota(values.begin(), values.end(), first);
    put(name, type, dimensions, values, attributes);
  }
  void put(const std::string& name, NcType type, const std::vector<std::string>& dimensions,
           const std::vector<double>& values, const std::vector<exodus::Attribute>& attributes = {}) const {
    const NcSink sink = file_.get().variable(name, type, dimensions, attributes);
    const std::vector<std::size_t> counts = sizes(dimensions);
    file_.get().later(
        [sink, counts, values] { sink.part(std::vector<std::size_t>(counts.size()), counts, values); });
  }
  void names(const std::string& name, const std::string& dimension,
             const std::vector<std::string>& of) const {
    const NcSink sink = file_.get().variable(name, exodus::kChar, {dimension, "len_name"});
    std::string table;
    for (const std::string& one : of) {
      table += one;
      table.resize((table.size() + kNameLength - 1) / kNameLength * kNameLength);
    }
    file_.get().later([sink, table, rows = of.size()] { sink.bytes({rows, kNameLength}, table); });
  }
  void dimension(const std::string& name, std::size_t length) {
    (void)file_.get().dimension({name, length});
    lengths_[name] = length;
  }

 private:
  [[nodiscard]] std::vector<std::size_t> sizes(const std::vector<std::string>& dimensions) const {
    std::vector<std::size_t> result(dimensions.size());
    std::transform(dimensions.begin(), dimensions.end(), result.begin(),
                   [&](const std::string& dimension) { return lengths_.at(dimension); });
    return result;
  }
  static std::size_t product(const std::vector<std::size_t>& sizes) {
    return std::accumulate(sizes.begin(), sizes.end(), std::size_t{1}, std::multiplies<>());
  }

  std::reference_wrapper<NcOutput> file_;
  std::map<std::string, std::size_t> lengths_;
};

void put_blocks(const Variables& file) {
  file.counted("eb_prop1", exodus::kInt, {"num_el_blk"}, 10, {exodus::text_attribute("name", "ID")});
  file.counted("eb_prop2", exodus::kInt, {"num_el_blk"}, 7, {exodus::text_attribute("name", "colour")});
  file.names("eb_names", "num_el_blk", {"solid", "skin"});
  file.put("connect1", exodus::kInt, {"num_el_in_blk1", "num_nod_per_el1"}, {1, 2, 3, 4, 2, 3, 4, 5},
           {exodus::text_attribute("elem_type", "TETRA4")});
  file.put("connect2", exodus::kInt, {"num_el_in_blk2", "num_nod_per_el2"}, {1, 2, 3},
           {exodus::text_attribute("elem_type", "TRI3")});
  file.counted("attrib1", exodus::kDouble, {"num_el_in_blk1", "num_att_in_blk1"}, 0.5);
  file.names("attrib_name1", "num_att_in_blk1", {"thick", "offset"});
  file.counted("attrib2", exodus::kFloat, {"num_el_in_blk2", "num_att_in_blk1"}, 5);
  file.counted("nattrb", exodus::kDouble, {"num_nodes", "num_att_in_nblk"}, 30);
  file.names("nattrib_name", "num_att_in_nblk", {"size"});
}

void put_sets(const Variables& file) {
  file.counted("ns_prop1", exodus::kInt, {"num_node_sets"}, 3, {exodus::text_attribute("name", "ID")});
  file.names("ns_names", "num_node_sets", {"left", "right"});
  file.put("node_ns1", exodus::kInt, {"num_nod_ns1"}, {3, 1, 5});
  file.put("node_ns2", exodus::kInt, {"num_nod_ns2"}, {4, 2});
  file.counted("dist_fact_ns1", exodus::kDouble, {"num_nod_ns1"}, 0.25);
  file.counted("ss_prop1", exodus::kInt, {"num_side_sets"}, 4, {exodus::text_attribute("name", "ID")});
  file.put("elem_ss1", exodus::kInt, {"num_side_ss1"}, {2, 1, 2});
  file.put("side_ss1", exodus::kInt, {"num_side_ss1"}, {1, 4, 3});
  file.counted("dist_fact_ss1", exodus::kDouble, {"num_df_ss1"}, 0.125);
  file.counted("els_prop1", exodus::kInt, {"num_elem_sets"}, 5, {exodus::text_attribute("name", "ID")});
  file.put("elem_els1", exodus::kInt, {"num_ele_els1"}, {3, 1});
}

void put_steps(const Variables& file) {
  file.counted("time_whole", exodus::kDouble, {"time_step"}, 0.5);
  file.names("name_glo_var", "num_glo_var", {"energy"});
  file.counted("vals_glo_var", exodus::kDouble, {"time_step", "num_glo_var"}, 11);
  file.names("name_nod_var", "num_nod_var", {"u", "v"});
  file.counted("vals_nod_var1", exodus::kDouble, {"time_step", "num_nodes"}, 20);
  file.counted("vals_nod_var2", exodus::kFloat, {"time_step", "num_nodes"}, 40);
  file.names("name_elem_var", "num_elem_var", {"stress", "strain"});
  file.put("elem_var_tab", exodus::kInt, {"num_el_blk", "num_elem_var"}, {1, 1, 0, 1});
  file.counted("vals_elem_var1eb1", exodus::kDouble, {"time_step", "num_el_in_blk1"}, 60);
  file.counted("vals_elem_var2eb1", exodus::kDouble, {"time_step", "num_el_in_blk1"}, 70);
  file.counted("vals_elem_var2eb2", exodus::kDouble, {"time_step", "num_el_in_blk2"}, 80);
  file.names("name_nset_var", "num_nset_var", {"load"});
  file.put("nset_var_tab", exodus::kInt, {"num_node_sets", "num_nset_var"}, {1, 0});
  file.counted("vals_nset_var1ns1", exodus::kDouble, {"time_step", "num_nod_ns1"}, 90);
  file.names("name_sset_var", "num_sset_var", {"flow"});
  file.counted("vals_sset_var1ss1", exodus::kDouble, {"time_step", "num_side_ss1"}, 100);
}

void put_numbers(const Variables& file) {
  file.counted("node_num_map", exodus::kInt, {"num_nodes"}, 200);
  file.counted("elem_num_map", exodus::kInt, {"num_elem"}, 300);
  file.counted("nm_prop1", exodus::kInt, {"num_node_maps"}, 8, {exodus::text_attribute("name", "ID")});
  file.names("nmap_names", "num_node_maps", {"owner", "ghost"});
  file.counted("node_map1", exodus::kInt, {"num_nodes"}, 400);
  file.counted("node_map2", exodus::kInt, {"num_nodes"}, 500);
}

}  // namespace

void write_exodus_seed(const std::filesystem::path& path, const exodus::Storage& storage) {
  NcOutput file(path, storage);
  Variables variables(file);
  for (const auto& [name, length] : std::initializer_list<std::pair<const char*, std::size_t>>{
           {"len_name", kNameLength}, {"time_step", 2},       {"num_dim", 3},         {"num_nodes", 5},
           {"num_elem", 3},           {"num_el_blk", 2},      {"num_el_in_blk1", 2},  {"num_nod_per_el1", 4},
           {"num_el_in_blk2", 1},     {"num_nod_per_el2", 3}, {"num_att_in_blk1", 2}, {"num_att_in_nblk", 1},
           {"num_node_sets", 2},      {"num_nod_ns1", 3},     {"num_nod_ns2", 2},     {"num_side_sets", 1},
           {"num_side_ss1", 3},       {"num_df_ss1", 9},      {"num_elem_sets", 1},   {"num_ele_els1", 2},
           {"num_node_maps", 2},      {"num_glo_var", 1},     {"num_nod_var", 2},     {"num_elem_var", 2},
           {"num_nset_var", 1},       {"num_sset_var", 1}}) {
    variables.dimension(name, length);
  }
  for (const char* const axis : {"coordx", "coordy", "coordz"}) {
    const double first = axis[5] == 'x' ? 0 : 10;
    variables.counted(axis, exodus::kDouble, {"num_nodes"}, first);
  }
  put_blocks(variables);
  put_sets(variables);
  put_steps(variables);
  put_numbers(variables);
  file.finish();
}

}  // namespace meshorder::fuzz
